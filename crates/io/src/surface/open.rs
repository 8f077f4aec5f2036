//! Facets -> welded triangles of a surface that need not enclose anything: a plate, a chute, a
//! hopper without a lid.

use super::duplicates::keep_one_of_equal;
use super::frame::Frame;
use super::mesh::{Edges, Mesh};
use super::sets::Sets;
use super::shells::join;
use super::{t_junctions, weld};
use crate::bounds::Bounds;
use crate::diagnostic::{Diagnostic, Result};
use crate::hash::fnv1a;
use crate::triangles::{self, read_facets};

/// A triangle lower than this share of the diagonal has no area.
const NO_HEIGHT: f64 = 1e-12;

/// A triangulated surface, open or closed, as it stands in the file: neither wound nor closed nor
/// checked for crossings.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenSurface {
    /// Where it came from, for messages: file name or "standard input".
    pub source: String,
    /// Hash of the bytes it came from (FNV-1a, 64 bit).
    pub source_hash: u64,
    /// Corners, m.
    pub vertices_m: Vec<[f64; 3]>,
    /// Three indices into `vertices_m` each.
    pub triangles: Vec<[u32; 3]>,
    /// Facets in the file.
    pub facets_read: usize,
    /// Corners that were moved onto another one within 3e-5 of the diagonal, because that closed a
    /// gap.
    pub welded_vertices: usize,
    /// Edges that were split on one side only, and now are on both.
    pub t_junctions: usize,
    /// Facets without area, dropped.
    pub degenerate_facets: usize,
    /// Facets that stood there already (either way round), dropped.
    pub duplicate_facets: usize,
    /// Triangles wound against the others of their part: those that are the fewer. 0: each part is
    /// wound one way.
    pub turned_facets: usize,
    /// Whether what the triangles enclose has a volume below 0, as where those of a closed surface
    /// look inwards. Says nothing of an open one.
    pub is_inside_out: bool,
    /// One sentence for each thing that is odd about the file but harmless.
    pub warnings: Vec<String>,
}

/// Reads the STL, OBJ, PLY or 3MF in `bytes` as a surface that may be open. `unit_m` is a unit of
/// the file, m, of which a 3MF needs none, `scale` a factor on all lengths. `source` names the file:
/// in messages, and where the contents do not say which it is.
///
/// Equal corners become one, and near ones where that closes a gap.
///
/// # Errors
/// No unit, one that is no positive number or not that of the file, no whole file of triangles (see
/// `read_facets`), an implausible size, or facets of which none has an area.
pub fn read_open_surface(
    bytes: &[u8],
    source: &str,
    unit_m: Option<f64>,
    scale: f64,
) -> Result<OpenSurface> {
    read(bytes, source, unit_m, scale)
        .map(|surface| OpenSurface {
            source: source.to_owned(),
            ..surface
        })
        .map_err(|error| error.within(source))
}

fn read(bytes: &[u8], source: &str, unit_m: Option<f64>, scale: f64) -> Result<OpenSurface> {
    let file = read_facets(bytes, source)?;
    let Some(unit_m) = triangles::unit_m(&file, unit_m, scale)? else {
        let problem = "the file has no unit of its own";
        return Err(Diagnostic::input(
            "",
            problem,
            "add unit = \"mm\" beside its name",
        ));
    };
    let facets_read = file.corners.len();
    let frame = Frame::around(&file.corners, unit_m)?;
    let mut mesh = weld::equal_corners(&frame.to_local(file.corners));
    let diagonal = Bounds::of(mesh.vertices.iter().copied()).diagonal_m();

    let mut dropped = drop_superfluous(&mut mesh, diagonal);
    let edges = Edges::of(&mesh);
    let welded = weld::near_vertices(&mut mesh, &edges, diagonal);
    let t_junctions = t_junctions::split(&mut mesh, weld::LARGEST_TOLERANCE * diagonal);
    let later = drop_superfluous(&mut mesh, diagonal);
    dropped = [dropped[0] + later[0], dropped[1] + later[1]];
    if mesh.triangles.is_empty() {
        return Err(Diagnostic::input(
            "",
            format!("none of the {facets_read} facets has an area"),
            "export the shape again",
        ));
    }
    let turned_facets = turned(&mesh, |_| true)
        .iter()
        .filter(|turned| **turned)
        .count();
    let is_inside_out = mesh.signed_volume(0..mesh.triangles.len() as u32) < 0.0;
    mesh.order_vertices();
    Ok(OpenSurface {
        source: String::new(),
        source_hash: fnv1a(bytes),
        vertices_m: mesh
            .vertices
            .iter()
            .map(|v| (frame.in_file(*v) * unit_m).into())
            .collect(),
        triangles: mesh.triangles,
        facets_read,
        welded_vertices: welded.map_or(0, |w| w.vertices_gone),
        t_junctions,
        degenerate_facets: dropped[0],
        duplicate_facets: dropped[1],
        turned_facets,
        is_inside_out,
        warnings: file.warnings,
    })
}

/// Drops triangles without area and all but one of equal ones, and sorts the rest. How many of
/// each.
///
/// Not the rule for solids, which drops both of a pair that stands there both ways round: here such
/// a pair is a plate. It is wound as most of equal ones are, and as its neighbours are where there
/// are as many of either way.
fn drop_superfluous(mesh: &mut Mesh, diagonal: f64) -> [usize; 2] {
    let all = mesh.triangles.len();
    let (degenerate, kept) = keep_one_of_equal(mesh, NO_HEIGHT * diagonal);
    if kept.contains(&0) {
        let turned = turned(mesh, |t| kept[t as usize] != 0);
        for (t, triangle) in mesh.triangles.iter_mut().enumerate() {
            if kept[t] == 0 && turned[t] {
                triangle.swap(1, 2);
            }
        }
    }
    [degenerate, all - degenerate - kept.len()]
}

/// Which triangles are wound against most of those connected to them over edges of two; `counts`
/// says which of these count.
fn turned(mesh: &Mesh, counts: impl Fn(u32) -> bool) -> Vec<bool> {
    let mut sets = Sets::new(mesh.triangles.len());
    for group in Edges::of(mesh).groups() {
        if let [a, b] = *group {
            // A strip with one side fits together no way: the first edges have their say.
            let _ = join(mesh, &mut sets, a, b);
        }
    }
    let all = 0..mesh.triangles.len() as u32;
    let found: Vec<(u32, bool)> = all.clone().map(|t| sets.find(t)).collect();
    // By root: those that are wound as it is, less those that are not.
    let mut majority = vec![0_i64; found.len()];
    for (t, (root, turned)) in all.zip(&found) {
        if counts(t) {
            majority[*root as usize] += if *turned { -1 } else { 1 };
        }
    }
    found
        .iter()
        .map(|(root, turned)| *turned != (majority[*root as usize] < 0))
        .collect()
}
