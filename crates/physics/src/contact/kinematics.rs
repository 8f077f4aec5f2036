//! Kinematics of two ends in contact: the only geometry that contact laws use.

use crate::number::{Number, Vec3};

/// A sphere that may be in contact: a free one, or one of a clump, which then has its share of the
/// clump's mass and moment of inertia.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSphere<T = f64> {
    /// Velocity of the centre halfway through the step, m/s: its displacement in the step over the
    /// time step.
    pub velocity_m_s: Vec3<T>,
    /// Spin halfway through the step, rad/s.
    pub spin_rad_s: Vec3<T>,
    /// Radius, m.
    pub radius_m: T,
    /// Inverse mass, 1/kg: 0 if it is held.
    pub inverse_mass_per_kg: T,
    /// Inverse moment of inertia, 1/(kg m^2): 0 if it is held.
    pub inverse_inertia_per_kg_m2: T,
}

/// Point of a wall nearest to a sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallPoint<T = f64> {
    /// Unit normal from the wall to the centre of the sphere.
    pub normal: Vec3<T>,
    /// The same a step before.
    pub normal_before: Vec3<T>,
    /// Distance of the centre from the wall, m.
    pub distance_m: T,
    /// Velocity of the wall's surface there, halfway through the step, m/s.
    pub velocity_m_s: Vec3<T>,
    /// Spin of the wall halfway through the step, rad/s.
    pub spin_rad_s: Vec3<T>,
}

/// Kinematics of b in contact with a, at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactKinematics<T = f64> {
    /// Unit normal from a to b.
    pub normal: Vec3<T>,
    /// The unit vector halfway between the normal a step before and now.
    pub middle: Vec3<T>,
    /// Overlap, m; if it is not above 0, the ends are apart.
    pub overlap_m: T,
    /// Branch vector lengths, from each centre to the contact point, m: radius minus half the
    /// overlap, 0 for a wall. Their sum is the distance of the centres, so torques balance.
    pub levers_m: [T; 2],
    /// Velocity of b's surface relative to a's at the contact point, halfway through the step, m/s.
    pub velocity_m_s: Vec3<T>,
    /// Spin of b relative to a halfway through the step, rad/s.
    pub spin_rad_s: Vec3<T>,
    /// Mean spin of the two about the normal, rad/s.
    pub mean_spin_rad_s: T,
    /// R_a R_b / (R_a + R_b), m; at a wall the sphere's radius.
    pub effective_radius_m: T,
    /// m_a m_b / (m_a + m_b), kg; at a wall the sphere's mass. 0 between two held ends.
    pub effective_mass_kg: T,
    /// J_a J_b / (J_a + J_b) with J = I + m R^2, kg m^2: inertia against rolling (Ai et al. 2011).
    /// 0 between two held ends.
    pub effective_rolling_inertia_kg_m2: T,
}

/// Stands for the inverse mass of two held ends, 1/kg, so that nothing is divided by 0.
const HELD_PER_KG: f64 = 1e-200;

/// Kinematics of two spheres after a step of `dt`, s; `apart_m` is the vector from the centre of a
/// to that of b. The centres must not coincide.
#[inline(always)]
pub fn contact_kinematics<T: Number>(
    apart_m: Vec3<T>,
    [a, b]: [ContactSphere<T>; 2],
    dt: f64,
) -> ContactKinematics<T> {
    let moving = b.velocity_m_s - a.velocity_m_s;
    let before_m = apart_m - moving.scale(dt);
    let (length, length_before) = (apart_m.square().sqrt(), before_m.square().sqrt());
    // The sum of the two normals, times both lengths; its length needs neither normal.
    let along = apart_m * length_before + before_m * length;
    let lengths = length * length_before;
    let along_length = (lengths * (lengths + apart_m.dot(before_m)))
        .scale(2.0)
        .sqrt();
    let [per_length, per_along] = inverses(length, along_length);
    let (normal, middle) = (apart_m * per_length, along * per_along);

    let reach = a.radius_m + b.radius_m;
    let overlap = reach - length;
    let halfway = (overlap + reach - length_before).scale(0.25);
    let (arm_a, arm_b) = (a.radius_m - halfway, b.radius_m - halfway);
    let levers_m = [
        a.radius_m - overlap.scale(0.5),
        b.radius_m - overlap.scale(0.5),
    ];
    let per_inertia = per_rolling_inertia(&a) + per_rolling_inertia(&b);
    let inverse_mass = a.inverse_mass_per_kg + b.inverse_mass_per_kg;
    let [per_reach, mass] = inverses(reach, inverse_mass.maximum(reach.zero().plus(HELD_PER_KG)));
    ContactKinematics {
        normal,
        middle,
        overlap_m: overlap,
        levers_m,
        velocity_m_s: moving - (a.spin_rad_s * arm_a + b.spin_rad_s * arm_b).cross(middle),
        spin_rad_s: b.spin_rad_s - a.spin_rad_s,
        mean_spin_rad_s: (a.spin_rad_s + b.spin_rad_s).dot(middle).scale(0.5),
        effective_radius_m: a.radius_m * b.radius_m * per_reach,
        effective_mass_kg: inverse_mass.if_positive(mass),
        effective_rolling_inertia_kg_m2: reduced(per_inertia),
    }
}

/// Kinematics of a sphere (b) and a wall (a), which has infinite mass and radius, after a step of
/// `dt`, s.
#[inline(always)]
pub fn wall_contact_kinematics<T: Number>(
    foot: &WallPoint<T>,
    b: ContactSphere<T>,
    dt: f64,
) -> ContactKinematics<T> {
    let moving = b.velocity_m_s - foot.velocity_m_s;
    let (middle, _) = unit(foot.normal_before + foot.normal);
    let overlap = b.radius_m - foot.distance_m;
    let lever = b.radius_m - overlap.scale(0.5);
    let arm = lever - moving.dot(middle).scale(0.25 * dt);
    ContactKinematics {
        normal: foot.normal,
        middle,
        overlap_m: overlap,
        levers_m: [lever.zero(), lever],
        velocity_m_s: moving - (b.spin_rad_s * arm).cross(middle),
        spin_rad_s: b.spin_rad_s - foot.spin_rad_s,
        mean_spin_rad_s: (foot.spin_rad_s + b.spin_rad_s).dot(middle).scale(0.5),
        effective_radius_m: b.radius_m,
        effective_mass_kg: reduced(b.inverse_mass_per_kg),
        effective_rolling_inertia_kg_m2: reduced(per_rolling_inertia(&b)),
    }
}

/// Torques on a and b about their centres, N m, from a force on b at the contact point, N, and a
/// moment on b, N m.
///
/// For a wall: about the contact point.
#[inline(always)]
pub fn torques<T: Number>(
    touch: &ContactKinematics<T>,
    force_on_b: Vec3<T>,
    moment_on_b: Vec3<T>,
) -> [Vec3<T>; 2] {
    let [lever_a, lever_b] = touch.levers_m;
    let turn = force_on_b.cross(touch.normal);
    [turn * lever_a - moment_on_b, turn * lever_b + moment_on_b]
}

/// Rotation of vectors across the normal together with it in a step: as its two halves.
#[derive(Debug, Clone, Copy)]
pub struct FrameRotation<T> {
    /// The normals at the beginning, in the middle and at the end of the step.
    normals: [Vec3<T>; 3],
    /// 1 / (1 + cosine) of half the rotation angle of the normal.
    per_rotation: T,
    /// Cosine and sine of half the mean rotation about the normal.
    spin: [T; 2],
}

impl<T: Number> FrameRotation<T> {
    /// For a step of `dt`, s.
    #[inline(always)]
    pub fn new(touch: &ContactKinematics<T>, dt: f64) -> Self {
        let (middle, normal) = (touch.middle, touch.normal);
        let cosine = middle.dot(normal);
        // The tangent of half the angle: of a quarter of the rotation in the step.
        let t = touch.mean_spin_rad_s.scale(0.25 * dt);
        let [per_square, per_rotation] = inverses((t * t).plus(1.0), cosine.plus(1.0));
        let per = per_square.scale(2.0);
        Self {
            normals: [middle * cosine.scale(2.0) - normal, middle, normal],
            per_rotation,
            spin: [per.plus(-1.0), t * per],
        }
    }

    /// Rotates a vector across the normal from the beginning of the step to its middle.
    #[inline(always)]
    pub fn to_middle(self, vector: Vec3<T>) -> Vec3<T> {
        let [before, middle, _] = self.normals;
        self.spun(vector - (before + middle) * (middle.dot(vector) * self.per_rotation))
    }

    /// Rotates a vector across the normal from the middle of the step to its end.
    #[inline(always)]
    pub fn to_end(&self, vector: Vec3<T>) -> Vec3<T> {
        let [_, middle, normal] = self.normals;
        let spun = self.spun(vector);
        spun - (middle + normal) * (normal.dot(spun) * self.per_rotation)
    }

    /// Rotates a vector about the normal in the middle of the step.
    #[inline(always)]
    fn spun(&self, vector: Vec3<T>) -> Vec3<T> {
        let [cosine, sine] = self.spin;
        vector * cosine + self.normals[1].cross(vector) * sine
    }
}

/// A vector's direction and length.
#[inline(always)]
fn unit<T: Number>(vector: Vec3<T>) -> (Vec3<T>, T) {
    let length = vector.square().sqrt();
    (vector * length.inverse(), length)
}

/// The inverses of two numbers, with one division, which takes longer than the products.
#[inline(always)]
fn inverses<T: Number>(a: T, b: T) -> [T; 2] {
    let of_both = (a * b).inverse();
    [b * of_both, a * of_both]
}

/// Inverse of a sum of inverses, 0 if that is 0.
#[inline(always)]
fn reduced<T: Number>(sum: T) -> T {
    sum.if_positive(sum.inverse())
}

/// Inverse of I + m R^2; 0 for a held end.
#[inline(always)]
fn per_rolling_inertia<T: Number>(ball: &ContactSphere<T>) -> T {
    let (per_mass, per_inertia) = (ball.inverse_mass_per_kg, ball.inverse_inertia_per_kg_m2);
    let sum = per_mass + per_inertia * ball.radius_m * ball.radius_m;
    sum.if_positive(per_mass * per_inertia / sum)
}

/// Depth to which an overlap, m, presses in the smaller of two spheres of these radii, m, over its
/// radius: the square of the radius of Hertz's contact over that of the sphere. It is the whole
/// overlap at a wall (an infinite radius), and half of it in each of two equal spheres.
pub fn indentation(overlap_m: f64, small_radius_m: f64, large_radius_m: f64) -> f64 {
    overlap_m / small_radius_m / (1.0 + small_radius_m / large_radius_m)
}
