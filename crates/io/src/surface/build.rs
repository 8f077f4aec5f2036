//! Facets -> welded, oriented shells.

use super::frame::Frame;
use super::intersections::{self, Intersections};
use super::mesh::{Edges, Mesh};
use super::nesting::{self, Place};
use super::rays::Rays;
use super::refusals::{no_volume, odd_edges, one_sided, open_edges};
use super::shells::connect;
use super::solid::{Repairs, Shell, Surface};
use super::union_volume::{Excess, excess};
use super::warnings::{Remarks, sentences};
use super::{duplicates, holes, t_junctions, weld};
use crate::bounds::Bounds;
use crate::boxes::Tree;
use crate::diagnostic::Result;
use crate::hash::fnv1a;
use crate::triangles::{self, read_facets};
use std::ops::Range;

/// How the numbers of a file of triangles are to be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReadSettings {
    /// Metres in one unit of the file. None: that of the file, if it has one (3MF), or else a
    /// millimetre.
    pub unit_m: Option<f64>,
    /// A further factor on all lengths.
    pub scale: f64,
    /// Close small holes instead of refusing them.
    pub fill_holes: bool,
}

/// A closed part whose volume is less than this share of its area (local units) encloses nothing.
const FLAT: f64 = 1e-10;

/// Metres in a unit of a file that has none, if none is given.
const USUAL_UNIT_M: f64 = 1e-3;

/// Reads the STL, OBJ, PLY or 3MF in `bytes` and makes a solid of it. `source` names it: in
/// messages, and where the contents do not say which it is.
///
/// The result does not depend on the order of the facets, on the corner that each begins with, or
/// on which way round they are wound. Corners within 3e-5 of the bounding box's diagonal are welded
/// where that closes the surface, and edges split on one side only within the same distance. With
/// `fill_holes`, holes are closed whose boundary is at most half the diagonal long, or that lack
/// just one facet.
///
/// # Errors
/// No whole file of triangles (see `read_facets`), or one that has another unit than the given; a
/// surface that is not closed, has edges with an odd number of
/// facets, has no two sides, or encloses nothing.
pub fn read_surface(bytes: &[u8], source: &str, settings: ReadSettings) -> Result<Surface> {
    build(bytes, source, settings)
        .map(|surface| Surface {
            source: source.to_owned(),
            ..surface
        })
        .map_err(|error| error.within(source))
}

/// All steps, in order.
fn build(bytes: &[u8], source: &str, settings: ReadSettings) -> Result<Surface> {
    let file = read_facets(bytes, source)?;
    let unit_m = triangles::unit_m(&file, settings.unit_m, settings.scale)?;
    let unit_m = unit_m.unwrap_or(USUAL_UNIT_M * settings.scale);
    let mut repairs = Repairs {
        facets_read: file.corners.len(),
        ..Repairs::default()
    };
    let mut remarks = Remarks::default();

    let mut frame = Frame::around(&file.corners, unit_m)?;
    let facets = frame.to_local(file.corners);
    let mut mesh = weld::equal_corners(&facets);
    drop(facets);
    let diagonal = Bounds::of(mesh.vertices.iter().copied()).diagonal_m();
    drop_superfluous(&mut mesh, &mut repairs);
    weld_and_split(&mut mesh, diagonal, frame.size * unit_m, &mut repairs);
    remarks.triangles = mesh.triangles.len();
    close_holes(
        &mut mesh,
        settings.fill_holes,
        &frame,
        diagonal,
        &mut repairs,
    )?;

    let mut parts = wind_outwards(&mut mesh, &frame, &mut remarks)?;
    frame.fit(&mut mesh);
    let relations = relate(&mut mesh, &mut parts);

    let local_unit_m = frame.size * unit_m;
    let volume_unit_m3 = local_unit_m.powi(3);
    let shells: Vec<Shell> = parts
        .iter()
        .zip(&relations.places)
        .map(|(part, place)| Shell {
            first_triangle: part.triangles.start as usize,
            triangle_count: part.triangles.len(),
            volume_m3: mesh.signed_volume(part.triangles.clone()).abs() * volume_unit_m3,
            is_cavity: place.is_cavity,
            outer_shell: place.outer_shell as usize,
        })
        .collect();
    repairs.flipped_facets = parts.iter().map(|part| part.turned).sum();
    repairs.self_intersections = relations.crossings.pairs;
    let mut surface = Surface {
        source: String::new(),
        source_hash: fnv1a(bytes),
        origin_m: (frame.corner * unit_m).into(),
        unit_m: local_unit_m,
        vertices: mesh.vertices.into_iter().map(Into::into).collect(),
        triangles: mesh.triangles,
        shells,
        overlap_volume_m3: relations.excess.volume * volume_unit_m3,
        overlap_volume_error_m3: relations.excess.error * volume_unit_m3,
        repairs,
        warnings: file.warnings,
    };
    remarks.overlap = relations.overlap;
    remarks.crossing_place = relations.crossings.place.map(|place| frame.show(place));
    remarks.volume_error = surface.overlap_volume_error_m3 / surface.volume_m3();
    surface
        .warnings
        .extend(sentences(&surface.repairs, &surface.shells, &remarks));
    Ok(surface)
}

/// Drops facets that bound nothing.
fn drop_superfluous(mesh: &mut Mesh, repairs: &mut Repairs) {
    let dropped = duplicates::drop_superfluous(mesh);
    repairs.degenerate_facets += dropped.degenerate;
    repairs.duplicate_facets += dropped.duplicate;
}

/// Closes gaps within the tolerance, if there are any: between corners, then between corners and
/// edges.
fn weld_and_split(mesh: &mut Mesh, diagonal: f64, unit_m: f64, repairs: &mut Repairs) {
    let edges = Edges::of(mesh);
    if edges.bad_count() == 0 {
        return;
    }
    if let Some(welded) = weld::near_vertices(mesh, &edges, diagonal) {
        repairs.welded_vertices = welded.vertices_gone;
        repairs.weld_tolerance_m = welded.tolerance * unit_m;
        drop_superfluous(mesh, repairs);
    }
    repairs.degenerate_facets +=
        duplicates::drop_loose_slivers(mesh, weld::LARGEST_TOLERANCE * diagonal);
    repairs.t_junctions = t_junctions::split(mesh, weld::LARGEST_TOLERANCE * diagonal);
    if repairs.t_junctions > 0 {
        drop_superfluous(mesh, repairs);
    }
}

/// Refuses what is not closed, or closes it if it is small and that is wanted.
fn close_holes(
    mesh: &mut Mesh,
    fill: bool,
    frame: &Frame,
    diagonal: f64,
    repairs: &mut Repairs,
) -> Result<()> {
    let edges = Edges::of(mesh);
    if let Some(refusal) = odd_edges(mesh, &edges, frame) {
        return Err(refusal);
    }
    if edges.bad_count() == 0 {
        return Ok(());
    }
    let connected = connect(mesh, &edges).map_err(|half_edge| one_sided(mesh, half_edge, frame))?;
    let found = holes::find(mesh, &edges, &connected.turned);
    if !fill || !found.iter().all(|hole| hole.is_small(mesh, diagonal)) {
        return Err(open_edges(mesh, &edges, &found, frame, diagonal));
    }
    let existing = holes::ExistingEdges::of(mesh, &edges);
    repairs.filled_holes = found.len();
    repairs.hole_triangles = found
        .iter()
        .map(|hole| holes::fill(mesh, &existing, hole))
        .sum();
    let edges_now = Edges::of(mesh);
    match odd_edges(mesh, &edges_now, frame) {
        Some(refusal) => Err(refusal),
        None if edges_now.bad_count() > 0 => {
            Err(open_edges(mesh, &edges_now, &[], frame, diagonal))
        }
        None => Ok(()),
    }
}

/// A closed part of the mesh.
struct Part {
    /// Its triangles in the mesh.
    triangles: Range<u32>,
    /// Triangles of it that do not close holes.
    original: usize,
    /// How many of those were turned.
    turned: usize,
}

/// Winds every part so that its volume is positive, drops parts without volume, and sorts the mesh
/// by part: from here on its order does not depend on that of the facets.
fn wind_outwards(mesh: &mut Mesh, frame: &Frame, remarks: &mut Remarks) -> Result<Vec<Part>> {
    let connected =
        connect(mesh, &Edges::of(mesh)).map_err(|half_edge| one_sided(mesh, half_edge, frame))?;
    let mut kept: Vec<(Vec<u32>, usize, usize)> = Vec::new();
    for part in connected.parts {
        let turned: Vec<u32> = part
            .iter()
            .copied()
            .filter(|t| connected.turned[*t as usize])
            .collect();
        turned
            .iter()
            .for_each(|t| mesh.triangles[*t as usize].swap(1, 2));
        let volume = mesh.signed_volume(part.iter().copied());
        if volume.abs() <= FLAT * mesh.area(part.iter().copied()) {
            remarks.flat_parts += 1;
            continue;
        }
        let is_original = |t: &u32| (*t as usize) < remarks.triangles;
        let original = part.iter().filter(|t| is_original(t)).count();
        let turned = turned.into_iter().filter(is_original).count();
        if volume < 0.0 {
            part.iter()
                .for_each(|t| mesh.triangles[*t as usize].swap(1, 2));
        }
        kept.push((
            part,
            original,
            if volume < 0.0 {
                original - turned
            } else {
                turned
            },
        ));
    }
    if kept.is_empty() {
        return Err(no_volume());
    }
    mesh.triangles = kept
        .iter()
        .flat_map(|(part, _, _)| part)
        .map(|t| mesh.triangles[*t as usize])
        .collect();
    mesh.order_vertices();
    let mut rest = std::mem::take(&mut mesh.triangles);
    let mut parts: Vec<(Vec<[u32; 3]>, usize, usize)> = Vec::with_capacity(kept.len());
    for (part, original, turned) in kept.into_iter().rev() {
        let mut triangles = rest.split_off(rest.len() - part.len());
        triangles.sort_unstable();
        parts.push((triangles, original, turned));
    }
    parts.sort_unstable();
    let ranges = parts.into_iter().map(|(triangles, original, turned)| {
        let first = mesh.triangles.len() as u32;
        mesh.triangles.extend(triangles);
        Part {
            triangles: first..mesh.triangles.len() as u32,
            original,
            turned,
        }
    });
    Ok(ranges.collect())
}

/// How the parts of a mesh stand to each other.
struct Relations {
    crossings: Intersections,
    /// Whether parts cross or overlap.
    overlap: bool,
    /// One for each part.
    places: Vec<Place>,
    excess: Excess,
}

/// Finds crossings, cavities (whose normals it turns into the void), and what overlaps count twice.
fn relate(mesh: &mut Mesh, parts: &mut [Part]) -> Relations {
    let boxes: Vec<Bounds> = (0..mesh.triangles.len() as u32)
        .map(|t| Bounds::of(mesh.corners(t)))
        .collect();
    let tree = Tree::new(&boxes);
    drop(boxes);
    let mut shell_of = vec![0_u32; mesh.triangles.len()];
    for (shell, part) in parts.iter().enumerate() {
        shell_of[part.triangles.start as usize..part.triangles.end as usize].fill(shell as u32);
    }
    let crossings = intersections::find(mesh, &tree, &shell_of);
    let ranges: Vec<Range<u32>> = parts.iter().map(|part| part.triangles.clone()).collect();
    let (places, overlap_in_plane) = nesting::find(
        &Rays {
            mesh,
            tree: &tree,
            shell_of: &shell_of,
        },
        &ranges,
        &crossings,
    );
    for (part, _) in parts
        .iter_mut()
        .zip(&places)
        .filter(|(_, place)| place.is_cavity)
    {
        part.triangles
            .clone()
            .for_each(|t| mesh.triangles[t as usize].swap(1, 2));
        part.turned = part.original - part.turned;
    }
    let overlap = overlap_in_plane || crossings.pairs > 0;
    let excess = if overlap {
        let shell_bounds: Vec<Bounds> = ranges
            .iter()
            .map(|range| Bounds::of(range.clone().flat_map(|t| mesh.corners(t))))
            .collect();
        let crossing = crossings
            .shells
            .iter()
            .map(|[a, b]| shell_bounds[*a as usize].common(&shell_bounds[*b as usize]));
        let whole = Bounds::of(mesh.vertices.iter().copied());
        let region = if overlap_in_plane {
            whole
        } else {
            crossing.reduce(|sum, b| sum.with(&b)).unwrap_or(whole)
        };
        excess(
            &Rays {
                mesh,
                tree: &tree,
                shell_of: &shell_of,
            },
            region,
        )
    } else {
        Excess::default()
    };
    for part in parts.iter() {
        mesh.triangles[part.triangles.start as usize..part.triangles.end as usize].sort_unstable();
    }
    Relations {
        crossings,
        overlap,
        places,
        excess,
    }
}
