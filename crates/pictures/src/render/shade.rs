//! Brightness of a point of a surface.

use nalgebra::Vector3;

use super::linear::mixed;
use super::scene::Scene;
use super::shapes::{Body, Face};

/// Light of the lamp and of the sky.
const LAMP: f32 = 0.72;
const SKY: f32 = 0.62;

/// Fraction by which the farthest objects fade into the white of the background.
const HAZE: f32 = 0.10;

/// Darkness of the border of a ball, and the cosine to the viewer at which it begins.
const RIM: f32 = 0.42;
const RIM_FROM: f32 = 0.5;

/// Darkening of walls by shadows.
const SHADOW: f32 = 0.46;
const DEPTH_OF_SKY: f32 = 0.50;

/// The light of a ball at `x`, `y`.
pub(super) fn body(scene: &Scene, body: &Body, x: f32, y: f32) -> [f32; 3] {
    let [nx, ny] = [x - body.centre.x, y - body.centre.y].map(|d| d / body.radius);
    let nz = (1.0 - nx * nx - ny * ny).max(0.0).sqrt();
    let normal = Vector3::new(nx, ny, nz);
    let point = body.centre + body.radius * normal;
    let [mean, along @ ..] = body.sky;
    let open = (mean + Vector3::from(along).dot(&normal)).clamp(0.0, 1.0);
    let sky = SKY * open * (0.62 + 0.38 * normal.dot(&scene.lights.zenith));
    let towards = scene.lights.lamp();
    let facing = normal.dot(&towards);
    let lamp = if facing > 0.0 {
        let bias = 1.0 + 0.12 * body.radius;
        facing * scene.lights.lamp_on_ball(point, bias)
    } else {
        0.0
    };
    let rim = (nz / RIM_FROM).min(1.0);
    let bright = (SKY * 0.08 + sky + LAMP * lamp) * (1.0 - RIM + RIM * rim);
    // The half vector between the lamp and the viewer.
    let half = towards + Vector3::z();
    let shine = normal.dot(&half).max(0.0) / half.norm();
    let shine = 0.16 * lamp.min(1.0) * shine.powi(24);
    hazy(scene, body.colour.map(|c| c * bright + shine), point.z)
}

/// The light of a wall at `x`, `y`, with this visible fraction of the sky.
pub(super) fn face(scene: &Scene, face: &Face, x: f32, y: f32, sky: f32) -> [f32; 3] {
    let point = face.point(x, y);
    let facing = face.normal.dot(&scene.lights.lamp());
    let lamp = if facing > 0.0 {
        scene.lights.lamp_on_wall(point, facing)
    } else {
        1.0
    };
    let form =
        0.70 + 0.30 * facing.max(0.0) + 0.20 * face.normal.dot(&scene.lights.zenith).max(0.0);
    let bright = form * (1.0 - SHADOW * (1.0 - lamp)) * (1.0 - DEPTH_OF_SKY * (1.0 - sky));
    hazy(scene, face.colour.map(|c| c * bright), point.z)
}

fn hazy(scene: &Scene, light: [f32; 3], depth: f32) -> [f32; 3] {
    let [far, near] = scene.depth;
    let back = ((near - depth) / (near - far).max(1.0)).clamp(0.0, 1.0);
    mixed(light, [1.0; 3], HAZE * back)
}
