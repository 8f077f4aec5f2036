//! The view holds what the frames hold.

use super::made_run::{Moment, folder_with, out, page_of, summary};
use super::reader::Read3d;

const MOMENTS: [Moment; 4] = [
    Moment {
        time_s: 0.0,
        particles: 9,
    },
    Moment {
        time_s: 0.4,
        particles: 9,
    },
    Moment {
        time_s: 1.0,
        particles: 12,
    },
    Moment {
        time_s: 2.0,
        particles: 5,
    },
];

#[test]
fn places_radii_and_bonds_are_those_of_the_frames() {
    let folder = folder_with(&MOMENTS);
    let view = Read3d::of(&page_of(&folder, &summary()));
    let unit_m = view.head["resolution_m"].as_f64().unwrap();
    let radius_unit_m = view.head["radius_unit_m"].as_f64().unwrap();
    // The longest edge, 2 m, in 24 bits.
    assert!(unit_m < 1.001 * 2.0 / f64::from(1 << 24), "{unit_m}");
    for (frame, moment) in MOMENTS.iter().enumerate() {
        let places = view.places_m(frame);
        assert_eq!(places.len(), moment.particles);
        for (i, place) in places.iter().enumerate() {
            let exact = moment.place_m(i);
            let off = (0..3)
                .map(|k| (place[k] - exact[k]).abs())
                .fold(0.0, f64::max);
            assert!(
                off <= 0.51 * unit_m,
                "frame {frame}, sphere {i}: off by {off} m"
            );
            let radius_m = view.tracks["radius"][frame][i] as f64 * radius_unit_m;
            assert!((radius_m - Moment::radius_m(i)).abs() <= 0.51 * radius_unit_m);
        }
        let bonds = moment.particles - 1;
        assert_eq!(
            view.tracks["a"][frame],
            (0..bonds as i64).collect::<Vec<_>>()
        );
        assert_eq!(
            view.tracks["b"][frame],
            (1..=bonds as i64).collect::<Vec<_>>()
        );
        let broken = (0..bonds).map(|bond| i64::from(moment.is_broken(bond)));
        assert_eq!(view.tracks["broken"][frame], broken.collect::<Vec<_>>());
    }
    assert_eq!(
        view.head["times_s"].as_array().unwrap().len(),
        MOMENTS.len()
    );
    assert_eq!(view.head["time_texts"][1], "400 ms");
}

#[test]
fn colours_follow_the_values() {
    let folder = folder_with(&MOMENTS);
    let view = Read3d::of(&page_of(&folder, &summary()));
    let ids: Vec<i64> = (0..12).map(|i| i / 4).collect();
    assert_eq!(view.tracks["fragment"][2], ids);
    assert!(view.head["piece_colours"].as_array().unwrap().len() >= 3);
    // Speeds are 0.5 m/s times the number; the last one is the fastest of all frames.
    let speeds = &view.tracks["speed"][2];
    assert_eq!((speeds[0], speeds[11]), (0, 255));
    assert_eq!(view.head["highest"]["speed"], "5.5 m/s");
    // Pulled bonds lie above 128, pressed ones below, half as far.
    let stresses = &view.tracks["bond_stress"][0];
    assert_eq!((stresses[0], stresses[1]), (255, 64));
}

#[test]
fn spheres_know_their_intact_bonds_only() {
    let folder = folder_with(&MOMENTS);
    let view = Read3d::of(&page_of(&folder, &summary()));
    // Sphere 4 of the third frame: bond 3 is broken, bond 4 is not.
    let bond = view.tracks["bond_utilisation"][2][4];
    assert_eq!(view.tracks["utilisation"][2][4], bond);
    assert_eq!(view.tracks["stress"][2][4], 255);
    // Sphere 5: the mean of -1e5 and 2e5 Pa, over 2e5 Pa.
    assert_eq!(view.tracks["stress"][2][5], 128 + 32);
}

#[test]
fn walls_are_where_they_were_and_bodies_have_names() {
    let folder = folder_with(&MOMENTS);
    let view = Read3d::of(&page_of(&folder, &summary()));
    let unit_m = view.head["resolution_m"].as_f64().unwrap();
    for (frame, moment) in MOMENTS.iter().enumerate() {
        assert_eq!(view.tracks["corner"][frame], [0, 1, 2]);
        let height_m = view.head["origin_m"][2].as_f64().unwrap()
            + unit_m * view.tracks["wall_z"][frame][2] as f64;
        assert!(
            (height_m - moment.time_s / 8.0).abs() <= 0.51 * unit_m,
            "{height_m}"
        );
    }
    assert_eq!(view.head["body_names"], serde_json::json!(["cake", "rock"]));
    let modes = view.head["modes"].as_array().unwrap();
    assert!(modes.iter().any(|mode| mode == "body"), "{modes:?}");
}

#[test]
fn loads_of_walls_are_where_the_walls_are_and_grow() {
    let folder = folder_with(&MOMENTS);
    let view = Read3d::of(&page_of(&folder, &summary()));
    let loads = &view.head["loads"];
    assert_eq!(
        loads,
        &serde_json::json!([
            { "track": "wear_depth", "name": "wear depth", "highest": "0.002 mm" },
            { "track": "impact", "name": "impact energy over area", "highest": "4 J/m2" },
        ])
    );
    let unit_m = view.head["resolution_m"].as_f64().unwrap();
    for (frame, moment) in MOMENTS.iter().enumerate() {
        // A square of two triangles; before it is hit it is left out, as is the other patch.
        let triangles = if moment.time_s > 0.0 { 2 } else { 0 };
        let level = (255.0 * moment.time_s / 2.0).round() as i64;
        for track in ["wear_depth", "impact"] {
            assert_eq!(view.tracks[track][frame], vec![level; triangles]);
        }
        let heights = &view.tracks["load_z"][frame];
        assert_eq!(heights.len(), 3 * triangles);
        for height in heights {
            let height_m = view.head["origin_m"][2].as_f64().unwrap() + unit_m * *height as f64;
            assert!((height_m - moment.time_s / 8.0).abs() <= 0.51 * unit_m);
        }
    }
}

#[test]
fn without_frames_there_is_no_view() {
    for moments in [
        &[][..],
        &[Moment {
            time_s: 0.0,
            particles: 0,
        }],
    ] {
        let folder = folder_with(moments);
        let page = page_of(&folder, &summary());
        assert!(!page.contains("view-data"), "{moments:?}");
        assert!(page.contains("drop"));
    }
}

#[test]
fn large_runs_are_thinned_out_and_it_is_said() {
    let moments: Vec<Moment> = (0..12)
        .map(|k| Moment {
            time_s: f64::from(k),
            particles: 230_000,
        })
        .collect();
    let folder = folder_with(&moments);
    let page = page_of(&folder, &summary());
    let view = Read3d::of(&page);
    assert_eq!(view.head["times_s"].as_array().unwrap().len(), 11);
    assert_eq!(view.tracks["x"][0].len(), 115_000);
    assert!(page.contains("11 of 12 frames are shown."), "frames");
    assert!(page.contains("One of 2 spheres is shown, as there are up to 230000."));
    // First and last moment are kept, and spheres keep their places.
    let places = view.places_m(10);
    let exact = moments[11].place_m(2 * 1000);
    assert!(
        (places[1000][0] - exact[0]).abs() < 1e-2,
        "{:?} {exact:?}",
        places[1000]
    );
    assert!(page.len() < 40_000_000, "{} bytes", page.len());
}

#[test]
fn a_damaged_frame_is_named() {
    let folder = folder_with(&MOMENTS);
    let frame = out(&folder).join("frames/frame_000002.vtp");
    let bytes = std::fs::read(&frame).unwrap();
    for end in [0, 40, 900, bytes.len() / 2] {
        std::fs::write(&frame, &bytes[..end]).unwrap();
        let error = dem_report::report(&out(&folder), &summary().to_string()).unwrap_err();
        assert!(
            error.to_string().contains("frame_000002.vtp"),
            "{end}: {error}"
        );
        assert_eq!(error.exit_code(), 2, "{end}");
    }
    std::fs::remove_file(&frame).unwrap();
    let error = dem_report::report(&out(&folder), &summary().to_string()).unwrap_err();
    assert!(error.to_string().contains("frame_000002.vtp"), "{error}");
}
