//! Files written by other programs. The vtk-*.vtp next to this file were written by VTK 9.7
//! (vtkXMLPolyDataWriter).

use dem_io::body::{csv, lammps, txt, vtp};
use dem_io::{Body, Result};

fn three(body: Result<Body>) -> Body {
    let body = body.unwrap();
    assert_eq!(
        body.positions,
        [[0.0, 0.0, 0.0], [0.001, 0.0, 0.0], [0.0, 0.001, 0.0001]]
    );
    assert_eq!(body.radii, [0.0006, 0.0005, 0.0007]);
    assert_eq!(body.bonds, [[0, 1], [0, 2]]);
    body
}

#[test]
fn vtk_in_every_encoding_without_compression() {
    let files: [&[u8]; 4] = [
        include_bytes!("vtk-ascii.vtp"),
        include_bytes!("vtk-base64.vtp"),
        include_bytes!("vtk-appended-base64.vtp"),
        include_bytes!("vtk-appended-raw.vtp"),
    ];
    for bytes in files {
        let body = three(vtp::read(&mut &bytes[..]));
        assert_eq!(body.bond_radii, [0.0004, 0.0003]);
        assert_eq!(
            body.bond_lengths,
            [0.001, (0.001_f64 * 0.001 + 0.0001 * 0.0001).sqrt()]
        );
        assert_eq!(body.about.program.as_deref(), Some("dem-pack 0.1 <ä>"));
        assert_eq!(
            (body.about.seed, body.about.overlap),
            (Some(u64::MAX), Some(0.1))
        );
    }
}

#[test]
fn vtk_with_vertices_single_precision_and_arrays_that_mean_nothing_here() {
    let body = vtp::read(&mut &include_bytes!("vtk-with-vertices.vtp")[..]).unwrap();
    assert_eq!(
        body.positions,
        [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]
    );
    assert_eq!(body.radii, [1.0, 2.0, 1.5]);
    assert_eq!(body.bonds, [[0, 1], [0, 2]]);
    assert_eq!(body.bond_radii, [0.5, 0.25]);
    assert_eq!(body.bond_lengths, [2.0, 3.0]);
}

#[test]
fn vtk_compressed_says_how_to_save() {
    let error = vtp::read(&mut &include_bytes!("vtk-compressed.vtp")[..]).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(
        error.problem.contains("compressed") && error.remedy.contains("SetCompressorTypeToNone"),
        "{error}"
    );
}

#[test]
fn bonds_without_radius_are_as_thick_as_their_smaller_particle() {
    let text = include_str!("vtk-ascii.vtp").replace("bond_radius_m", "thickness");
    assert_eq!(
        three(vtp::read(&mut text.as_bytes())).bond_radii,
        [0.0005, 0.0006]
    );
}

#[test]
fn vtp_that_is_no_body() {
    let text = include_str!("vtk-ascii.vtp");
    let said = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        vtp::read(&mut text.replacen(from, to, 1).as_bytes())
            .unwrap_err()
            .to_string()
    };
    for (from, to, wanted) in [
        (
            "\"radius_m\"",
            "\"r\"",
            "the radii of the particles are missing: the point data are 'r'; name the point data that hold them 'radius_m'",
        ),
        (
            "2 4\n",
            "3 4\n",
            "array 'offsets': line 0 does not have two points; a bond joins two: save each bond as a line of its own",
        ),
        (
            "\"PolyData\"",
            "\"UnstructuredGrid\"",
            "this VTK file holds 'UnstructuredGrid', not 'PolyData'; save the body as PolyData (.vtp)",
        ),
        (
            "LittleEndian",
            "BigEndian",
            "the numbers are big endian; save the file as little endian or ascii",
        ),
        (
            "0 1 2 0",
            "0 1 2 3",
            "bond 1: it joins particle 3, but there are 3 particles, numbered from 0; correct or remove this bond",
        ),
        (
            "0 1 2 0",
            "0 1 1 0",
            "bond 1: it joins particles 0 and 1, as bond 0 does already; one pair takes one bond: remove one of the two",
        ),
        (
            "0 1 2 0",
            "0 1 2 -1",
            "array 'connectivity': -1 is not the number of a particle; the file is damaged: write or copy it again",
        ),
        (
            "0.0006 0.0005 0.0007",
            "0.0006 0 0.0007",
            "particle 1: its radius is 0 m, but must be positive and finite; correct or remove it",
        ),
        (
            "0.0006 0.0005 0.0007",
            "0.0006 0.0005",
            "array 'radius_m': 2 values, but the header says 3; the file is damaged: write or copy it again",
        ),
        (
            "0 0 0 0.001 0 0",
            "0 0 0 nan 0 0",
            "particle 1: x is NaN, but must be a finite number of metres; correct or remove this particle",
        ),
        (
            "NumberOfLines=\"2\"",
            "NumberOfLines=\"3\"",
            "array 'bond_radius_m': 2 values, but the header says 3; the file is damaged: write or copy it again",
        ),
        (
            "</Lines>",
            "</Line>",
            "the XML is damaged: ill-formed document: expected `</Lines>`, but `</Line>` was found; write or copy the file again",
        ),
    ] {
        assert_eq!(said(from, to), wanted);
    }
    let two_pieces = text.replace("</Piece>", "</Piece><Piece NumberOfPoints=\"0\"></Piece>");
    assert!(
        vtp::read(&mut two_pieces.as_bytes())
            .unwrap_err()
            .problem
            .contains("several pieces")
    );
}

#[test]
fn lammps_as_write_data_writes_it() {
    let text = "LAMMPS data file via write_data, version 22 Jul 2025, timestep = 0, units = si\n\n3 atoms\n1 atom types\n\
                2 bonds\n1 bond types\n\n-1 2 xlo xhi\n-1 2 ylo yhi\n-1 2 zlo zhi\n\nAtoms # bpm/sphere\n\n\
                3 1 1 0.0014 2050.0000000000005 0 0.001 0.0001 0 0 0\n1 1 1 0.0012 2050 0 0 0 0 0 0\n\
                2 1 1 0.001 2049.9999999999995 0.001 0 0 0 0 0\n\nVelocities\n\n3 0 0 0 0 0 0\n1 0 0 0 0 0 0\n\
                2 0 0 0 0 0 0\n\nBonds\n\n1 1 1 2\n2 1 3 1\n";
    three(lammps::read(&mut text.as_bytes()));
    let said = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        lammps::read(&mut text.replacen(from, to, 1).as_bytes())
            .unwrap_err()
            .to_string()
    };
    for (from, to, wanted) in [
        (
            "bpm/sphere",
            "bond",
            "line 12: the atom style is 'bond'; write the atoms with atom_style bpm/sphere",
        ),
        (
            "3 atoms",
            "4 atoms",
            "3 atoms, but the head of the file says 4; it may be cut off: write or copy it again",
        ),
        (
            "3 1 1",
            "2 1 1",
            "two atoms have the number 2; number the atoms 1, 2, 3, ...: 'reset_atoms id'",
        ),
        (
            "3 1 1",
            "4 1 1",
            "line 14: the number of the atom is 4, but there are 3 particles, numbered from 1; correct or remove this line",
        ),
        (
            "0.001 2049.9999999999995",
            "0.001 1000",
            "line 16: the density is 1e3, but that of the first atom is 2.0500000000000005e3; a body has particles of one density: 'set group all density ...'",
        ),
        (
            "0.0001 0 0 0",
            "0.0001 0 -1 0",
            "line 14: the atom has gone through a periodic boundary; write the data with fixed or shrink-wrapped boundaries",
        ),
        (
            "0.0014",
            "1.4mm",
            "line 14: the diameter is '1.4mm', not a number; numbers have a decimal point and no unit",
        ),
        (
            "2 1 3 1\n",
            "2 1 3\n",
            "line 27: the second atom is missing; the line is incomplete",
        ),
    ] {
        assert_eq!(said(from, to), wanted);
    }
}

#[test]
fn tables_from_spreadsheets_and_matlab() {
    let particles = "\u{feff}id, radius_m ,x_m,y_m,z_m\r\n7,0.0006,0,0,0\r\n8,5e-4,0.001,0,0\r\n9,7.0E-4,0,1e-3,.0001\r\n\r\n";
    let bonds = "particle_b,particle_a\n1,0\n0,2\n";
    three(csv::read(&mut particles.as_bytes(), &mut bonds.as_bytes()));
    let particles = "% x y z r\n 0 0 0 0.0006\n1.0000000e-03\t0 0 5e-4\n\n0,0.001,0.0001,7e-4\n";
    three(txt::read(
        &mut particles.as_bytes(),
        &mut "1 2\n3 1\n".as_bytes(),
    ));
    let said = |particles: &str, bonds: &str| {
        csv::read(&mut particles.as_bytes(), &mut bonds.as_bytes())
            .unwrap_err()
            .to_string()
    };
    let good = "x_m,y_m,z_m,radius_m\n0,0,0,1\n2,0,0,1\n";
    for (particles, bonds, wanted) in [
        (
            "x;y\n",
            "particle_a,particle_b\n",
            "particles: line 1: there is no column 'x_m'; the first line names the columns: x_m,y_m,z_m,radius_m",
        ),
        (
            good,
            "",
            "bonds: line 1: there is no column 'particle_a'; the first line names the columns: particle_a,particle_b,bond_radius_m,initial_length_m",
        ),
        (
            "x_m,y_m,z_m,radius_m\n0,0,0\n",
            "particle_a,particle_b\n",
            "particles: line 2: radius_m is missing; the line is incomplete",
        ),
        (
            good,
            "particle_a,particle_b\n0,2\n",
            "bonds: line 2: particle_b is 2, but there are 2 particles, numbered from 0; correct or remove this line",
        ),
        (
            good,
            "particle_a,particle_b\n0,1\n1,0\n",
            "bonds: bond 1: it joins particles 0 and 1, as bond 0 does already; one pair takes one bond: remove one of the two",
        ),
        (
            good,
            "particle_a,particle_b,bond_radius_m\n0,1,1 mm\n",
            "bonds: line 2: bond_radius_m is '1 mm', not a number; numbers have a decimal point and no unit",
        ),
    ] {
        assert_eq!(said(particles, bonds), wanted);
    }
    let error = txt::read(
        &mut "0 0 0 1\n2 0 0 1\n".as_bytes(),
        &mut "0 1\n".as_bytes(),
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "bonds: line 1: the first particle is 0, but there are 2 particles, numbered from 1; correct or remove this line"
    );
}
