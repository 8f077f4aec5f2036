//! How bright a point of a surface is. Colours are proportional to light: the square of what is
//! stored in a picture.

use super::{Body, Face, Scene};
use crate::vector::dot_f32 as dot;

/// Light of the lamp and of the sky.
const LAMP: f32 = 0.72;
const SKY: f32 = 0.62;

/// What the farthest things lose to the white of the background.
const HAZE: f32 = 0.10;

/// How dark the border of a ball is, and from which cosine to the viewer it begins.
const RIM: f32 = 0.42;
const RIM_FROM: f32 = 0.5;

/// How much shadows darken walls.
const SHADOW: f32 = 0.46;
const DEPTH_OF_SKY: f32 = 0.50;

/// Light of a stored colour.
pub(super) fn linear(colour: [u8; 3]) -> [f32; 3] {
    colour.map(|c| {
        let share = f32::from(c) / 255.0;
        share * share
    })
}

/// The stored colour of a light.
pub(super) fn stored(light: [f32; 3]) -> [u8; 3] {
    light.map(|c| (255.0 * c.clamp(0.0, 1.0).sqrt() + 0.5) as u8)
}

pub(super) fn mixed(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]))
}

/// The light of a ball where it is seen at `x`, `y`.
pub(super) fn body(scene: &Scene, body: &Body, x: f32, y: f32) -> [f32; 3] {
    let [nx, ny] = [x - body.centre[0], y - body.centre[1]].map(|d| d / body.radius);
    let nz = (1.0 - nx * nx - ny * ny).max(0.0).sqrt();
    let normal = [nx, ny, nz];
    let point = [0, 1, 2].map(|k| body.centre[k] + body.radius * normal[k]);
    let [mean, along @ ..] = body.sky;
    let open = (mean + dot(along, normal)).clamp(0.0, 1.0);
    let sky = SKY * open * (0.62 + 0.38 * dot(normal, scene.lights.zenith));
    let towards = scene.lights.lamp();
    let facing = dot(normal, towards);
    let lamp = if facing > 0.0 {
        let bias = 1.0 + 0.12 * body.radius;
        facing * scene.lights.lamp_on_ball(point, bias)
    } else {
        0.0
    };
    let rim = (nz / RIM_FROM).min(1.0);
    let bright = (SKY * 0.08 + sky + LAMP * lamp) * (1.0 - RIM + RIM * rim);
    // The half vector between the lamp and the viewer.
    let half = [towards[0], towards[1], towards[2] + 1.0];
    let shine = dot(normal, half).max(0.0) / dot(half, half).sqrt();
    let shine = 0.16 * lamp.min(1.0) * shine.powi(24);
    hazy(scene, body.colour.map(|c| c * bright + shine), point[2])
}

/// The light of a wall where it is seen at `x`, `y`, and sees so much of the sky.
pub(super) fn face(scene: &Scene, face: &Face, x: f32, y: f32, sky: f32) -> [f32; 3] {
    let point = face.point(x, y);
    let facing = dot(face.normal, scene.lights.lamp());
    let lamp = if facing > 0.0 {
        scene.lights.lamp_on_wall(point, facing)
    } else {
        1.0
    };
    let form =
        0.70 + 0.30 * facing.max(0.0) + 0.20 * dot(face.normal, scene.lights.zenith).max(0.0);
    let bright = form * (1.0 - SHADOW * (1.0 - lamp)) * (1.0 - DEPTH_OF_SKY * (1.0 - sky));
    hazy(scene, face.colour.map(|c| c * bright), point[2])
}

fn hazy(scene: &Scene, light: [f32; 3], depth: f32) -> [f32; 3] {
    let [far, near] = scene.depth;
    let back = ((near - depth) / (near - far).max(1.0)).clamp(0.0, 1.0);
    mixed(light, [1.0; 3], HAZE * back)
}
