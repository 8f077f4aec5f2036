//! Formats that are not read, by what they begin with or how their names end: what they are, and
//! how to convert them.

use crate::diagnostic::Diagnostic;

/// A format that is not read.
struct Format {
    name: &'static str,
    /// What its files begin with.
    begins: &'static [&'static [u8]],
    /// How their names end, in lower case.
    ends: &'static [&'static str],
    made_by: MadeBy,
}

/// Which programs make such files.
enum MadeBy {
    /// Surfaces of a CAD program, without triangles.
    Cad,
    /// Meshes of other programs.
    Mesh,
    /// Scenes of Blender.
    Blender,
}

const FORMATS: [Format; 21] = [
    of(
        MadeBy::Cad,
        "STEP",
        &[b"ISO-10303-21"],
        &["step", "stp", "p21"],
    ),
    of(MadeBy::Cad, "IGES", &[], &["iges", "igs"]),
    of(
        MadeBy::Cad,
        "BREP",
        &[b"DBRep_DrawableShape"],
        &["brep", "brp"],
    ),
    of(MadeBy::Cad, "FreeCAD", &[], &["fcstd"]),
    of(MadeBy::Cad, "Parasolid", &[], &["x_t", "x_b"]),
    of(MadeBy::Cad, "ACIS", &[], &["sat", "sab"]),
    of(MadeBy::Cad, "SolidWorks", &[], &["sldprt", "sldasm"]),
    of(MadeBy::Cad, "Inventor", &[], &["ipt", "iam"]),
    of(MadeBy::Cad, "CATIA", &[], &["catpart", "catproduct"]),
    of(MadeBy::Cad, "DXF", &[], &["dxf"]),
    of(MadeBy::Cad, "DWG", &[b"AC10"], &["dwg"]),
    of(MadeBy::Cad, "OpenSCAD", &[], &["scad"]),
    of(MadeBy::Mesh, "VRML", &[b"#VRML"], &["wrl", "vrml"]),
    of(MadeBy::Mesh, "X3D", &[], &["x3d"]),
    of(MadeBy::Mesh, "glTF", &[b"glTF"], &["glb", "gltf"]),
    of(MadeBy::Mesh, "FBX", &[b"Kaydara FBX"], &["fbx"]),
    of(MadeBy::Mesh, "COLLADA", &[], &["dae"]),
    of(MadeBy::Mesh, "AMF", &[], &["amf"]),
    of(MadeBy::Mesh, "OFF", &[b"OFF"], &["off"]),
    of(
        MadeBy::Mesh,
        "VTK",
        &[b"# vtk", b"<VTKFile", b"<?xml version=\"1.0\"?>\n<VTKFile"],
        &["vtk", "vtp", "vtu"],
    ),
    of(MadeBy::Blender, "Blender", &[b"BLENDER"], &["blend"]),
];

const fn of(
    made_by: MadeBy,
    name: &'static str,
    begins: &'static [&'static [u8]],
    ends: &'static [&'static str],
) -> Format {
    Format {
        name,
        begins,
        ends,
        made_by,
    }
}

/// The refusal of a file of a format that is known, but not read. `ending` is that of its name, in
/// lower case.
pub(super) fn refusal(text: &[u8], ending: &str) -> Option<Diagnostic> {
    let begins = |format: &&Format| format.begins.iter().any(|start| text.starts_with(start));
    let ends = |format: &&Format| format.ends.contains(&ending);
    let format = FORMATS
        .iter()
        .find(begins)
        .or_else(|| FORMATS.iter().find(ends))?;
    let (what, remedy) = match format.made_by {
        MadeBy::Cad => (
            "which has no triangles",
            "export it as STL or 3MF from the program that made it, or from FreeCAD",
        ),
        MadeBy::Mesh => (
            "which is not read",
            "export it as STL, OBJ, PLY or 3MF, or convert it with MeshLab or meshio",
        ),
        MadeBy::Blender => (
            "which is not read",
            "export it from Blender as STL, OBJ or PLY",
        ),
    };
    let problem = format!("a file of the format {}, {what}", format.name);
    Some(Diagnostic::input("", problem, remedy))
}
