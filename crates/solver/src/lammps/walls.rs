//! Walls as `fix wall/gran/region`.
//!
//! Planes, and boxes and cylinders along the axes, are regions of LAMMPS. They may move without
//! turning.

use dem_io::Result;
use dem_scene::{Factor, Scene, WallMotion};

use super::contacts::law_in_words;
use super::feeds::Feed;
use super::forces::formula;
use super::words::{self, ALONG, block, numbers, refused};
use crate::geometry::{Shape, SolidBox};
use crate::plan::Plan;
use crate::plan::contacts::NO_KIND;
use crate::state::walls::Wall;

/// A wall in the words of LAMMPS.
#[derive(Debug, Clone)]
pub(super) struct WrittenWall {
    /// Its name in the scene.
    pub name: String,
    /// Style and arguments of its region.
    pub region: String,
    /// Formulas of the displacement along x, y, z; None: it does not move.
    pub moves: Option<[String; 3]>,
    /// For each material that it meets, the law.
    pub laws: Vec<(usize, String)>,
}

/// The walls of a planned scene.
///
/// # Errors
/// A surface, a box or cylinder across the axes, a belt, a servo or a turning wall.
pub(super) fn walls(scene: &Scene, plan: &Plan, feeds: &[Feed]) -> Result<Vec<WrittenWall>> {
    let materials: Vec<&String> = scene.materials.keys().collect();
    let mut present = vec![false; materials.len()];
    for &material in plan.state.contacts.iter().flat_map(|c| &c.materials) {
        present[material as usize] = true;
    }
    for feed in feeds {
        present[feed.material] = true;
    }
    let mut walls = Vec::new();
    for wall in &plan.state.walls {
        let model = &wall.model;
        let part = format!("[walls.{}]", model.name);
        if model.surface_velocity_m_s != [0.0; 3] {
            return Err(refused(
                scene,
                &part,
                "a region has no belt that moves while it stands",
                "leave surface_velocity out, or run the scene with dem-run",
            ));
        }
        let region = region(scene, &part, wall)?;
        let moves = moves(scene, &part, &model.motion)?;
        let mut laws = Vec::new();
        let kinds = model.kind_of.iter().enumerate();
        for (material, &kind) in kinds.filter(|(m, kind)| **kind != NO_KIND && present[*m]) {
            let names = format!("{} with [walls.{}]", materials[material], model.name);
            let law = law_in_words(scene, &names, &model.kinds[kind as usize])?;
            laws.push((material, law));
        }
        walls.push(WrittenWall {
            name: model.name.clone(),
            region,
            moves,
            laws,
        });
    }
    Ok(walls)
}

/// Style and arguments of the region of a wall.
fn region(scene: &Scene, part: &str, wall: &Wall) -> Result<String> {
    let frame = &wall.frame;
    match &wall.model.shape {
        Shape::Plane(plane) => {
            let point = frame.to_space(plane.point_m());
            let normal = frame.direction_to_space(plane.normal());
            Ok(format!(
                "plane {} {} side in",
                numbers(&point),
                numbers(&normal)
            ))
        }
        Shape::Box(solid) => {
            let corners = corners(scene, part, wall, solid)?;
            Ok(format!("{} side out", block(corners)))
        }
        Shape::Cylinder(cylinder) => {
            let ends_m = cylinder.ends_m().map(|end| frame.to_space(end));
            let Some(region) = words::cylinder(ends_m, cylinder.radius_m()) else {
                return Err(refused(
                    scene,
                    part,
                    "the region cylinder is along an axis, and this wall is not",
                    "turn the scene, or run it with dem-run",
                ));
            };
            Ok(format!("{region} side out"))
        }
        Shape::Mesh(_) => Err(refused(
            scene,
            part,
            "fix wall/gran has planes, boxes and cylinders, but no triangles",
            "replace the surface by planes, boxes and cylinders, or run the scene with dem-run",
        )),
    }
}

/// The corners of a box along the axes.
fn corners(scene: &Scene, part: &str, wall: &Wall, solid: &SolidBox) -> Result<[[f64; 3]; 2]> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let is_along = |axis: [f64; 3]| {
        let turned = wall.frame.direction_to_space(axis);
        turned.iter().any(|x| x.abs() >= ALONG)
    };
    if !axes.into_iter().all(is_along) {
        return Err(refused(
            scene,
            part,
            "the region block is along the axes, and this box is turned",
            "replace it by planes, or run the scene with dem-run",
        ));
    }
    let bounds = solid.bounds();
    let [one, other] = [bounds.low, bounds.high].map(|corner| wall.frame.to_space(corner));
    Ok([
        [0, 1, 2].map(|k| one[k].min(other[k])),
        [0, 1, 2].map(|k| one[k].max(other[k])),
    ])
}

/// The displacement of a wall along x, y and z as formulas of the time.
fn moves(scene: &Scene, part: &str, motion: &WallMotion) -> Result<Option<[String; 3]>> {
    let turns = || {
        Err(refused(
            scene,
            part,
            "the exported regions move, but do not turn",
            "leave angular_velocity and angular_displacement out, or run the scene with dem-run",
        ))
    };
    match motion {
        WallMotion::Fixed => Ok(None),
        WallMotion::Velocity {
            velocity_m_s,
            spin_rad_s,
            factor,
        } => {
            if *spin_rad_s != [0.0; 3] {
                return turns();
            }
            let travelled = match factor {
                Factor::One => "time".to_owned(),
                Factor::Ramp { until_s } => format!(
                    "((time<{until_s:e})*time*time/{:e}+(time>={until_s:e})*(time-{:e}))",
                    2.0 * until_s,
                    0.5 * until_s
                ),
                Factor::Table(_) => {
                    return Err(refused(
                        scene,
                        part,
                        "the path of a region is a formula, and a table of velocities has no short one",
                        "give a table of displacements instead",
                    ));
                }
            };
            Ok(Some(velocity_m_s.map(|v| format!("{v:e}*{travelled}"))))
        }
        WallMotion::Displacement {
            displacement_m,
            angular_displacement_rad,
            factor,
        } => {
            if *angular_displacement_rad != [0.0; 3] {
                return turns();
            }
            let factor = formula(factor);
            Ok(Some(displacement_m.map(|d| format!("{d:e}*{factor}"))))
        }
        WallMotion::Servo { .. } | WallMotion::Bar { .. } | WallMotion::Weight { .. } => {
            Err(refused(
                scene,
                part,
                "a region that moves with particles around it takes no force as a target",
                "give it a velocity or a displacement",
            ))
        }
    }
}
