//! Walls as `fix wall/gran/region`, and surfaces as `fix surface/global`.
//!
//! Planes, and boxes and cylinders along the axes, are regions of LAMMPS, which may move without
//! turning. A surface is a file of triangles. Where LAMMPS has no `fix surface/global`, one that is
//! convex as seen from within and stands is the intersection of planes.
//!
//! <https://docs.lammps.org/fix_wall_gran_region.html>,
//! <https://docs.lammps.org/fix_surface_global.html>

use dem_scene::Scene;
use nalgebra::Vector3;

use super::contacts::law_in_words;
use super::feeds::Feed;
use super::refusals::Refusals;
use super::surfaces::{Face, depth_m, faces};
use super::wall_motion::{SurfaceMotion, moves, surface_motion};
use super::words::{self, ALONG, block, numbers};
use dem_engine::state::contacts::NO_KIND;
use dem_engine::state::walls::Wall;
use dem_io::units::significant;
use dem_physics::geometry::mesh::Mesh;
use dem_physics::geometry::one_surface::ALIKE;
use dem_physics::geometry::{Shape, SolidBox};
use dem_plan::Plan;

/// A wall in the words of LAMMPS.
#[derive(Debug, Clone)]
pub(super) struct WrittenWall {
    /// Its name in the scene.
    pub name: String,
    /// Number from 1.
    pub number: usize,
    /// Its shape, with its motion.
    pub shape: WrittenShape,
    /// For each material that it meets, the law.
    pub laws: Vec<(usize, String)>,
}

/// The shape of a wall, with its motion.
#[derive(Debug, Clone)]
pub(super) enum WrittenShape {
    /// Style and arguments of a region, and formulas of its displacement along x, y, z; None: it
    /// does not move.
    Region(String, Option<[String; 3]>),
    /// Triangles in a file.
    Surface(WrittenSurface),
}

/// A wall of triangles.
#[derive(Debug, Clone)]
pub(super) struct WrittenSurface {
    /// The corners of each at the start, m.
    pub triangles_m: Vec<[[f64; 3]; 3]>,
    /// Its motion.
    pub motion: SurfaceMotion,
    /// Style and arguments of the planes that intersect in the same wall, or why there are none.
    pub planes: Result<Vec<String>, String>,
}

impl WrittenWall {
    /// Name of the file of its triangles.
    pub(super) fn file(&self) -> String {
        format!("wall-{}.stl", self.number)
    }

    /// It as a surface, if it is one.
    pub(super) fn surface(&self) -> Option<&WrittenSurface> {
        match &self.shape {
            WrittenShape::Surface(surface) => Some(surface),
            WrittenShape::Region(..) => None,
        }
    }
}

/// The angle below which two triangles that meet are one surface, as in `dem-run`, degrees.
pub(super) fn flat_degrees() -> String {
    significant(ALIKE.acos().to_degrees(), 6)
}

/// The walls of a planned scene. Refuses belts and servos, boxes and cylinders across the axes, and
/// motions that LAMMPS has no word for.
pub(super) fn walls(
    scene: &Scene,
    plan: &Plan,
    feeds: &[Feed],
    refusals: &mut Refusals,
) -> Vec<WrittenWall> {
    let materials: Vec<&String> = scene.materials.keys().collect();
    let mut present = vec![false; materials.len()];
    for &material in plan.state.contacts.iter().flat_map(|c| &c.materials) {
        present[material as usize] = true;
    }
    for feed in feeds {
        present[feed.material] = true;
    }
    let mut walls = Vec::new();
    for (number, wall) in (1..).zip(&plan.state.walls) {
        let model = &wall.model;
        if model.surface_velocity_m_s != [0.0; 3] {
            refusals.add(
                format!("walls.{}.surface_velocity", model.name),
                "its walls have no belt that moves while they stand",
                "leave surface_velocity out, or run the scene with dem-run",
            );
        }
        let own = &scene.walls[&model.name].material;
        let mut laws = Vec::new();
        let kinds = model.kind_of.iter().enumerate();
        for (material, &kind) in kinds.filter(|(m, kind)| **kind != NO_KIND && present[*m]) {
            let names = format!("{}-{own}", materials[material]);
            let law = law_in_words(&names, &model.kinds[kind as usize], refusals);
            laws.extend(law.map(|law| (material, law)));
        }
        walls.extend(shape(plan, wall, refusals).map(|shape| WrittenWall {
            name: model.name.clone(),
            number,
            shape,
            laws,
        }));
    }
    walls
}

/// The shape of a wall with its motion. None: it is refused.
fn shape(plan: &Plan, wall: &Wall, refusals: &mut Refusals) -> Option<WrittenShape> {
    let frame = &wall.frame;
    let part = format!("[walls.{}]", wall.model.name);
    let mut refuse = |why: &str, remedy: &str| {
        refusals.add(&*part, why, remedy);
        None
    };
    let region = match &wall.model.shape {
        Shape::Plane(plane) => {
            let point = frame.to_space(plane.point_m());
            let normal = frame.direction_to_space(plane.normal());
            Some(plane_region(&point, &normal))
        }
        Shape::Box(solid) => match corners(wall, solid) {
            Some(corners) => Some(format!("{} side out", block(corners))),
            None => refuse(
                "the region block is along the axes, and this box is turned",
                "replace it by a surface (stl) or planes, or run the scene with dem-run",
            ),
        },
        Shape::Cylinder(cylinder) => {
            let ends_m = cylinder.ends_m().map(|end| frame.to_space(end));
            match words::cylinder(ends_m, cylinder.radius_m()) {
                Some(region) => Some(format!("{region} side out")),
                None => refuse(
                    "the region cylinder is along an axis, and this wall is not",
                    "replace it by a surface (stl), turn the scene, or run it with dem-run",
                ),
            }
        }
        Shape::Mesh(mesh) => {
            let motion = surface_motion(&part, wall, refusals)?;
            return Some(WrittenShape::Surface(surface(plan, wall, mesh, motion)));
        }
    };
    let moves = moves(&part, &wall.model.motion, refusals);
    Some(WrittenShape::Region(region?, moves?))
}

/// A wall of triangles.
fn surface(plan: &Plan, wall: &Wall, mesh: &Mesh, motion: SurfaceMotion) -> WrittenSurface {
    let to_space = |corners: [[f64; 3]; 3]| corners.map(|corner| wall.frame.to_space(corner));
    let planes = match motion {
        SurfaceMotion::Stands => {
            let up = -Vector3::from(plan.state.model.gravity_m_s2);
            let up = up.try_normalize(0.0).unwrap_or_default();
            faces(mesh, &wall.frame, up).and_then(|faces| holds_all(plan, faces))
        }
        _ => Err("it moves".to_owned()),
    };
    let region = |[point, normal]: &Face| plane_region(&(*point).into(), &(*normal).into());
    WrittenSurface {
        triangles_m: mesh.corners_m().map(to_space).collect(),
        motion,
        planes: planes.map(|faces| faces.iter().map(region).collect()),
    }
}

fn plane_region(point: &[f64; 3], normal: &[f64; 3]) -> String {
    format!("plane {} {} side in", numbers(point), numbers(normal))
}

/// These faces, if all particles and inlets are in front of them.
fn holds_all(plan: &Plan, faces: Vec<Face>) -> Result<Vec<Face>, String> {
    let is_in = |place: &Vector3<f64>| faces.iter().all(|face| depth_m(face, place) > 0.0);
    let particles = plan.state.particles.poses.iter();
    let mut particles = particles.map(dem_engine::state::particles::Pose::place);
    if !particles.all(|place| is_in(&place)) {
        return Err("there are particles outside".to_owned());
    }
    let rules = &plan.state.model.rules;
    let of_inlets = rules
        .inlets
        .iter()
        .map(|inlet| &rules.regions[inlet.region]);
    let mut corners = of_inlets.flat_map(|region| region.bounds().corners().map(Vector3::from));
    if !corners.all(|corner| is_in(&corner)) {
        return Err("there is an inlet outside".to_owned());
    }
    Ok(faces)
}

/// The corners of a box along the axes. None: it is turned.
fn corners(wall: &Wall, solid: &SolidBox) -> Option<[[f64; 3]; 2]> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let is_along = |axis: [f64; 3]| {
        let turned = wall.frame.direction_to_space(axis);
        turned.iter().any(|x| x.abs() >= ALONG)
    };
    let bounds = solid.bounds();
    let [one, other] = [bounds.low, bounds.high].map(|corner| wall.frame.to_space(corner));
    axes.into_iter().all(is_along).then(|| {
        [
            [0, 1, 2].map(|k| one[k].min(other[k])),
            [0, 1, 2].map(|k| one[k].max(other[k])),
        ]
    })
}
