//! Conditions that hold for any bytes given to the reader of files of triangles. Shared by the fuzz
//! target and the bounded run of the ordinary tests.

use dem_io::surface::{ReadSettings, read_surface};

/// Reads `bytes` as a file of triangles, with and without filling holes: the result is an error, or
/// a surface that is closed and finite.
pub(crate) fn read_stl(bytes: &[u8]) {
    for fill_holes in [false, true] {
        match read_surface(
            bytes,
            "fuzz.stl",
            ReadSettings {
                unit_m: None,
                scale: 1.0,
                fill_holes,
            },
        ) {
            Ok(surface) => assert_solid(&surface),
            Err(error) => {
                assert_eq!(error.exit_code(), 2);
                let text = error.to_string();
                assert!(
                    text.starts_with("fuzz.stl: ") && !error.problem.is_empty(),
                    "{text}"
                );
                assert!(text.chars().all(|c| !c.is_control()), "{text:?}");
            }
        }
    }
}

/// Checks that every number is finite, coordinates are as documented, every edge is traversed as
/// often forwards as backwards, and shells are one after another.
pub(crate) fn assert_solid(surface: &dem_io::Surface) {
    let extent = surface.extent();
    assert!(
        (1.0..2.0).contains(&extent.iter().copied().fold(0.0, f64::max)),
        "{extent:?}"
    );
    assert!(
        surface
            .vertices
            .iter()
            .flatten()
            .all(|x| (0.0..2.0).contains(x))
    );
    assert!((0..3).all(|k| surface.vertices.iter().any(|v| v[k] == 0.0)));
    assert!(
        surface.origin_m.iter().all(|x| x.is_finite())
            && surface.unit_m.is_finite()
            && surface.unit_m > 0.0
    );
    assert!(surface.volume_m3().is_finite() && surface.overlap_volume_error_m3.is_finite());
    let mut edges: Vec<(u32, u32, i32)> = Vec::new();
    for triangle in &surface.triangles {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            assert!(a != b && (a as usize) < surface.vertices.len());
            edges.push((a.min(b), a.max(b), if a < b { 1 } else { -1 }));
        }
    }
    edges.sort_unstable();
    for edge in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        assert_eq!(edge.iter().map(|e| e.2).sum::<i32>(), 0, "edge {edge:?}");
    }
    let mut next = 0;
    for (i, shell) in surface.shells.iter().enumerate() {
        assert_eq!(shell.first_triangle, next);
        next += shell.triangle_count;
        assert!(shell.volume_m3 > 0.0 && shell.volume_m3.is_finite());
        assert_eq!(shell.is_cavity, shell.outer_shell != i);
        assert!(shell.outer_shell < surface.shells.len());
    }
    assert_eq!(next, surface.triangles.len());
}
