//! Written bodies read back the same, bit for bit for all data that the format stores.

use std::path::Path;

use dem_io::Body;
use dem_io::body::{About, csv, lammps, read_body, txt, vtp, write_body};
use proptest::prelude::*;

use super::bodies::{any_body, bits, triangle, usual_body, with_derived_bonds};

fn written(write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    bytes
}

proptest! {
    #[test]
    fn vtp_loses_nothing(body in any_body()) {
        let bytes = written(|out| vtp::write(&body, out));
        let read = vtp::read(&mut bytes.as_slice()).unwrap();
        prop_assert_eq!(bits(&read), bits(&body));
        prop_assert_eq!(read.about, body.about);
    }

    #[test]
    fn csv_loses_nothing_but_where_it_came_from(body in any_body()) {
        let particles = written(|out| csv::write_particles(&body, out));
        let bonds = written(|out| csv::write_bonds(&body, out));
        let read = csv::read(&mut particles.as_slice(), &mut bonds.as_slice()).unwrap();
        prop_assert_eq!(bits(&read), bits(&body));
        prop_assert_eq!(read.about, About::default());
    }

    #[test]
    fn txt_keeps_particles_and_ends(body in usual_body()) {
        let particles = written(|out| txt::write_particles(&body, out));
        let bonds = written(|out| txt::write_bonds(&body, out));
        let read = txt::read(&mut particles.as_slice(), &mut bonds.as_slice()).unwrap();
        prop_assert_eq!(bits(&read), bits(&with_derived_bonds(body)));
    }

    #[test]
    fn lammps_keeps_particles_ends_and_density(mut body in usual_body(), density in prop::option::of(1e-3..1e5)) {
        body.about.particle_density_kg_m3 = density;
        let bytes = written(|out| lammps::write(&body, out));
        let read = lammps::read(&mut bytes.as_slice()).unwrap();
        prop_assert_eq!(read.about.particle_density_kg_m3, Some(density.unwrap_or(1000.0)));
        prop_assert_eq!(bits(&read), bits(&with_derived_bonds(body)));
    }
}

/// A separate reader for this layout, as simple as the format allows: header by text search, arrays
/// by their offset. (The crate vtkio cannot replace it: as published it reads appended data in
/// base64 only.)
#[test]
fn an_independent_reader_sees_the_same() {
    let body = triangle();
    let bytes = written(|out| vtp::write(&body, out));
    let underscore = bytes.windows(2).position(|pair| pair == b"\n_").unwrap() + 1;
    let header = std::str::from_utf8(&bytes[..underscore]).unwrap();
    assert!(header.contains("<Piece NumberOfPoints=\"3\" NumberOfLines=\"2\" NumberOfVerts=\"0\""));
    assert!(header.contains("byte_order=\"LittleEndian\" header_type=\"UInt64\""));
    let array = |section: &str, kind: &str, name: &str| -> Vec<[u8; 8]> {
        let section = header.split(&format!("<{section}>")).nth(1).unwrap();
        let element = section
            .split(&format!("<DataArray type=\"{kind}\" Name=\"{name}\""))
            .nth(1)
            .unwrap();
        let offset: usize = element
            .split("offset=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .parse()
            .unwrap();
        let data = &bytes[underscore + 1 + offset..];
        let length = u64::from_le_bytes(data[..8].try_into().unwrap()) as usize;
        data[8..8 + length]
            .chunks_exact(8)
            .map(|value| value.try_into().unwrap())
            .collect()
    };
    let floats = |section, name| -> Vec<f64> {
        array(section, "Float64", name)
            .into_iter()
            .map(f64::from_le_bytes)
            .collect()
    };
    let integers = |section, name| -> Vec<i64> {
        array(section, "Int64", name)
            .into_iter()
            .map(i64::from_le_bytes)
            .collect()
    };
    assert_eq!(floats("Points", "Points"), body.positions.as_flattened());
    assert_eq!(integers("Lines", "connectivity"), [0, 1, 0, 2]);
    assert_eq!(integers("Lines", "offsets"), [2, 4]);
    assert_eq!(floats("PointData", "radius_m"), body.radii);
    assert_eq!(floats("CellData", "bond_radius_m"), body.bond_radii);
    assert_eq!(floats("CellData", "initial_length_m"), body.bond_lengths);
}

fn through_file(body: &Body, path: &Path) -> Body {
    write_body(body, path).unwrap();
    read_body(path).unwrap()
}

#[test]
fn the_ending_of_the_name_chooses_the_format() {
    let folder = tempfile::tempdir().unwrap();
    let body = triangle();
    let derived = with_derived_bonds(triangle());
    for (name, files, body) in [
        ("a.vtp", vec!["a.vtp"], &body),
        ("b.VTP", vec!["b.VTP"], &body),
        (
            "c.v2.csv",
            vec!["c.v2.particles.csv", "c.v2.bonds.csv"],
            &body,
        ),
        ("d.bonds.csv", vec!["d.particles.csv", "d.bonds.csv"], &body),
        ("e.txt", vec!["e.particles.txt", "e.bonds.txt"], &derived),
        ("f.data", vec!["f.data"], &derived),
        ("g.lmp", vec!["g.lmp"], &derived),
        ("h.lammps", vec!["h.lammps"], &derived),
    ] {
        let path = folder.path().join(name);
        assert_eq!(bits(&through_file(body, &path)), bits(body), "{name}");
        for file in files {
            assert!(folder.path().join(file).is_file(), "{file}");
        }
    }
    // These formats have no place for the length of a bond without load.
    for name in ["e.txt", "f.data"] {
        let error = write_body(&triangle(), &folder.path().join(name)).unwrap_err();
        assert!(error.problem.contains("stretched or pressed"), "{error}");
    }
}

#[test]
fn files_for_other_programs_look_as_documented() {
    let body = triangle();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    assert_eq!(
        text(written(|out| csv::write_particles(&body, out))),
        "x_m,y_m,z_m,radius_m\n0e0,0e0,0e0,6e-4\n1e-3,0e0,0e0,5e-4\n-0e0,1e-3,1e-4,7e-4\n"
    );
    assert_eq!(
        text(written(|out| csv::write_bonds(&body, out))),
        "particle_a,particle_b,bond_radius_m,initial_length_m\n0,1,4e-4,1e-3\n0,2,3e-4,1.1e-3\n"
    );
    assert_eq!(
        text(written(|out| txt::write_particles(&body, out))),
        "0e0 0e0 0e0 6e-4\n1e-3 0e0 0e0 5e-4\n-0e0 1e-3 1e-4 7e-4\n"
    );
    assert_eq!(
        text(written(|out| txt::write_bonds(&body, out))),
        "1 2\n1 3\n"
    );
    let data = text(written(|out| lammps::write(&body, out)));
    let lines: Vec<&str> = data.lines().collect();
    assert_eq!(
        lines[2..6],
        ["3 atoms", "2 bonds", "1 atom types", "1 bond types"]
    );
    assert!(
        lines[7].starts_with("-2.0999999999999999e-3 2.8") && lines[7].ends_with(" xlo xhi"),
        "{}",
        lines[7]
    );
    assert_eq!(lines[11], "Atoms # bpm/sphere");
    assert_eq!(
        lines[14],
        "2 1 1 1.0000000000000000e-3 2.0500000000000000e3 1.0000000000000000e-3 0.0000000000000000e0 \
         0.0000000000000000e0"
    );
    assert_eq!(lines[16..], ["", "Bonds", "", "1 1 1 2", "2 1 1 3"][..]);
}
