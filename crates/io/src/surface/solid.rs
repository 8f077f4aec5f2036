//! What is known of a solid once its facets are joined and repaired.

use serde::Serialize;

/// One connected closed part of a surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shell {
    /// Its triangles are `Surface::triangles[first_triangle..first_triangle + triangle_count]`.
    pub first_triangle: usize,
    /// How many triangles it has.
    pub triangle_count: usize,
    /// Enclosed volume in m3, always positive. Where the shell crosses itself, parts enclosed twice
    /// count twice.
    pub volume_m3: f64,
    /// An inner shell: what it encloses is void.
    pub is_cavity: bool,
    /// The outer shell that a cavity lies in; its own index for an outer shell.
    pub outer_shell: usize,
}

/// What was done to the facets of the file to make a solid of them. All zero for a clean file.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Repairs {
    /// Facets in the file.
    pub facets_read: usize,
    /// Corners that were moved onto another one within `weld_tolerance_m` (not counting exact
    /// matches).
    pub welded_vertices: usize,
    /// Largest distance at which two corners were taken for one, m.
    pub weld_tolerance_m: f64,
    /// Facets without area, dropped.
    pub degenerate_facets: usize,
    /// Facets that stood there already (either way round), dropped.
    pub duplicate_facets: usize,
    /// Facets turned so that the normals of their shell point out of the solid.
    pub flipped_facets: usize,
    /// Edges split on one side only (T-junctions), closed in space by splitting them on the other
    /// side too.
    pub t_junctions: usize,
    /// Holes closed on request.
    pub filled_holes: usize,
    /// Triangles added to close holes.
    pub hole_triangles: usize,
    /// Pairs of triangles that cross each other and share no vertex. The union is meant.
    pub self_intersections: usize,
}

/// A closed triangulated surface of one or several shells, every normal pointing out of the solid.
///
/// Coordinates are local, so that neither a large offset nor a small size costs digits: a point in
/// space is `origin_m + unit_m * local`, the smallest corner of the bounding box is at the local
/// origin and the largest extent is between 1 and 2 local units.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Where it came from, for messages and metadata: file name or "standard input".
    pub source: String,
    /// Hash of the bytes it came from (FNV-1a, 64 bit).
    pub source_hash: u64,
    /// The local origin in space, m. Length 3.
    pub origin_m: [f64; 3],
    /// One local unit in metres.
    pub unit_m: f64,
    /// Corners, in local units.
    pub vertices: Vec<[f64; 3]>,
    /// Three indices into `vertices` each, counter-clockwise seen from outside the solid. Sorted by
    /// shell.
    pub triangles: Vec<[u32; 3]>,
    /// The connected parts.
    pub shells: Vec<Shell>,
    /// What the volumes of the shells count more than once because shells cross or overlap, m3:
    /// zero when none does.
    pub overlap_volume_m3: f64,
    /// Estimated error of `overlap_volume_m3`, m3: it is integrated over columns.
    pub overlap_volume_error_m3: f64,
    /// What was repaired.
    pub repairs: Repairs,
    /// One sentence for each thing that a user should know (repairs, T-junctions,
    /// self-intersections).
    pub warnings: Vec<String>,
}

impl Surface {
    /// Volume of the solid in m3: the outer shells less their cavities and less what is counted
    /// more than once.
    pub fn volume_m3(&self) -> f64 {
        let sum: f64 = self
            .shells
            .iter()
            .map(|s| {
                if s.is_cavity {
                    -s.volume_m3
                } else {
                    s.volume_m3
                }
            })
            .sum();
        sum - self.overlap_volume_m3
    }

    /// Number of parts: shells that are no cavities.
    pub fn parts(&self) -> usize {
        self.shells.iter().filter(|s| !s.is_cavity).count()
    }

    /// The largest corner of the bounding box, in local units (the smallest is the origin). Length
    /// 3.
    pub fn extent(&self) -> [f64; 3] {
        let mut extent = [0.0_f64; 3];
        for v in &self.vertices {
            for k in 0..3 {
                extent[k] = extent[k].max(v[k]);
            }
        }
        extent
    }

    /// The corners of one triangle, in local units. Three points of length 3.
    pub fn corners(&self, triangle: usize) -> [[f64; 3]; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }
}
