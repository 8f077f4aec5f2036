//! Rigid clumps: bodies that move as one, and their spheres.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::bonds::Bonds;
use super::particles::{Motion, Particles, Pose, Wrench};
use dem_physics::bending::{self, SlenderBody};
use dem_physics::bond::failure::{Criteria, smallest_strength_pa};
use dem_physics::clump_stress::Hits;
use dem_physics::rotation::{kinetic_j, spin_rad_s};
use dem_physics::rotation::{numbers, rotation};
use dem_physics::shape::inertia::MassProperties;
use dem_physics::shape::landing::{Landing, RigidSpheres};

/// A sphere of a template.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SubSphere {
    /// Centre, relative to the clump's centre along its principal axes, m. Length 3.
    pub place_m: [f64; 3],
    /// Orientation of the sphere relative to the principal axes: unit quaternion x, y, z, w.
    pub turned: [f64; 4],
    /// m.
    pub radius_m: f64,
    /// Mass, kg, as a particle of the bonded cluster.
    pub mass_kg: f64,
    /// Moment of inertia, kg m2, as a particle of the bonded cluster.
    pub inertia_kg_m2: f64,
}

/// The spheres of a rigid body with these mass properties, from particles at their present poses.
pub fn sub_spheres<'a>(
    particles: impl Iterator<Item = (&'a Pose, &'a Motion)>,
    properties: &MassProperties,
) -> Vec<SubSphere> {
    let to_principal = rotation(properties.axes).inverse();
    let centre = Vector3::from(properties.centre_m);
    let sphere = |(pose, motion): (&Pose, &Motion)| SubSphere {
        place_m: (to_principal * (pose.place() - centre)).into(),
        turned: numbers(&(to_principal * pose.rotation())),
        radius_m: pose.radius_m(),
        mass_kg: 1.0 / motion.inverse_mass,
        inertia_kg_m2: 1.0 / motion.inverse_inertia,
    };
    particles.map(sphere).collect()
}

/// Largest distance of a point of these spheres from the centre of mass, m.
pub fn reach_m(spheres: &[SubSphere]) -> f64 {
    let reach = |s: &SubSphere| Vector3::from(s.place_m).norm() + s.radius_m;
    spheres.iter().map(reach).fold(0.0, f64::max)
}

/// Volume of some spheres, overlaps counted twice, m3.
pub fn sphere_volume_m3(spheres: &[SubSphere]) -> f64 {
    let cubes = spheres.iter().map(|sphere| sphere.radius_m.powi(3));
    4.0 / 3.0 * std::f64::consts::PI * cubes.sum::<f64>()
}

/// Mean stress times volume of some spheres from which these bonds between them break, N m: the
/// smallest strength of their rules. Infinite: they cannot break.
pub fn breaks_from_n_m(bonds: &Bonds, spheres: &[SubSphere]) -> f64 {
    let rules = bonds.rule_runs.iter().map(|(_, rule)| &bonds.rules[*rule]);
    let strengths = rules.filter_map(|rule| rule.criteria.as_ref().map(smallest_strength_pa));
    strengths.fold(f64::INFINITY, f64::min) * sphere_volume_m3(spheres)
}

/// The sections of a clump of these spheres and bonds, with this mass, kg, and these principal
/// moments, kg m2. None: it is not slender, or bending does not break its bonds.
pub fn slender_body(
    bonds: &Bonds,
    spheres: &[SubSphere],
    (mass_kg, moments_kg_m2): (f64, [f64; 3]),
) -> Option<SlenderBody> {
    let mut rules = bonds.rule_runs.iter().map(|(_, rule)| &bonds.rules[*rule]);
    if !rules.any(|rule| rule.criteria.as_ref().is_some_and(Criteria::count_bending)) {
        return None;
    }
    let part = |sphere: &SubSphere| bending::Part {
        place_m: sphere.place_m.into(),
        radius_m: sphere.radius_m,
        mass_kg: sphere.mass_kg,
        inertia_kg_m2: sphere.inertia_kg_m2,
    };
    let parts: Vec<bending::Part> = spheres.iter().map(part).collect();
    let bond = |at: usize| bending::Bond {
        ends_m: bonds.ends[at].map(|end| spheres[end as usize].place_m.into()),
        radius_m: bonds.radius_m(at),
        axial_stiffness_n: bonds.normal(at) * bonds.initial_length_m(at),
    };
    let bonds: Vec<bending::Bond> = (0..bonds.len()).map(bond).collect();
    SlenderBody::of(&parts, (mass_kg, moments_kg_m2), &bonds)
}

/// Strengths that vary from bond to bond.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scatter {
    /// Of the scene.
    pub seed: u64,
    /// Weibull modulus.
    pub modulus: f64,
}

/// Data common to clumps of one shape. Stored once, whatever the number of clumps. Bodies of one
/// file share its arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Template {
    /// Name of the body in the scene.
    pub body: String,
    /// kg.
    pub mass_kg: f64,
    /// Principal moments of inertia, ascending, kg m2. Length 3.
    pub moments_kg_m2: [f64; 3],
    /// Rotation from the principal axes to those of the body's file: unit quaternion x, y, z, w.
    pub axes: [f64; 4],
    /// Centre of mass in the axes of the file, m. Length 3.
    pub centre_m: [f64; 3],
    /// Largest distance of a point from the centre of mass, m.
    pub reach_m: f64,
    /// All its spheres.
    pub spheres: Arc<Vec<SubSphere>>,
    /// The outer spheres, which can be touched: numbers in `spheres`, ascending. Only these are in
    /// the scene while the body is a clump.
    pub outer: Arc<Vec<u32>>,
    /// Ratio of the radius of a contact sphere of the clump to that of the sphere.
    pub scale: f64,
    /// Number of its material.
    pub material: u8,
    /// Bonds of the cluster that it can become, between numbers in `spheres`. Empty: none.
    pub bonds: Arc<Bonds>,
    /// For each of `spheres`, its number in the body's file.
    pub file_number: Arc<Vec<u32>>,
    /// For each of the `spheres` of a fragment, its id: see [`Particles::id`]. Empty: not a
    /// fragment.
    pub ids: Vec<u32>,
    /// Scatter of bond strengths. None: no scatter.
    pub scatter: Option<Scatter>,
    /// For each of `bonds`, its number in the body's file.
    pub bonds_of_file: Arc<Vec<u32>>,
    /// Mean stress times volume from which its bonds would break, N m; infinite if they cannot.
    pub breaks_from_n_m: f64,
    /// Its sections. None: it is not slender, or bending does not break its bonds.
    pub slender: Option<SlenderBody>,
    /// What its clumps land on, once it is known.
    #[serde(skip)]
    pub landing: KnownLanding,
}

/// A [`Landing`] that follows from the other data of a template, once it has been asked for.
#[derive(Debug, Clone, Default)]
pub struct KnownLanding(OnceLock<Landing>);

impl PartialEq for KnownLanding {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Template {
    /// Radius of the largest sphere of its clumps, m.
    pub(crate) fn largest_m(&self) -> f64 {
        self.outer_radii_m().fold(0.0, f64::max) * self.scale
    }

    /// Radii of the outer spheres, not scaled, m.
    fn outer_radii_m(&self) -> impl Iterator<Item = f64> {
        self.outer
            .iter()
            .map(|&sphere| self.spheres[sphere as usize].radius_m)
    }

    /// Largest distance of a point from the centre of mass, as a clump or as the cluster that it
    /// can become, m.
    pub fn largest_reach_m(&self) -> f64 {
        self.reach_m * self.scale.max(1.0)
    }
}

/// A rigid clump. Like those of particles, velocity and angular momentum are half a step before or
/// after its position.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Clump {
    /// Its template.
    pub template: u32,
    /// Its number among the clusters.
    pub cluster: u32,
    /// Number of bodies of the scene added before it.
    pub instance: u32,
    /// Id of the first sphere of its body's file: see [`Particles::id`].
    pub first_id: u32,
    /// Centre of mass, m. Length 3.
    pub place_m: [f64; 3],
    /// Rotation from its principal axes to space: unit quaternion x, y, z, w.
    pub turned: [f64; 4],
    /// Of the centre of mass, m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// About the centre of mass, along the axes of space, kg m2/s. Length 3.
    pub angular_momentum: [f64; 3],
    /// Force on it in this step, N. Length 3.
    pub force_n: [f64; 3],
    /// Torque about its centre of mass, N m. Length 3.
    pub torque_n_m: [f64; 3],
    /// The first of its spheres among the particles.
    pub first: u32,
    /// Its range of [`Clumps::near`]: the first index and the one after the last.
    pub near: [u32; 2],
    /// Energy that contacts have taken from its motion so far, J: the sum over all times at which
    /// they slowed it down.
    pub impact_energy_j: f64,
    /// Energy that it has taken in, if daughters can replace it.
    pub intake: Intake,
    /// It became rigid while it touched what its trigger names, and still touches it.
    pub rigid_while_touching: bool,
    /// Hits that would have broken its bonds.
    pub hits: Hits,
    /// Distance that the fastest of its points moved in the last drift, m, at most.
    #[serde(skip)]
    pub moved_m: f64,
    /// Whether it sleeps: then it is skipped, and nothing is near it.
    pub asleep: bool,
}

/// Energy that a particle has taken in from its contacts: their normal forces, times the speed at
/// which both sides approach, over time; its share of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Intake {
    /// In the present impact, which began when something touched the particle, J.
    pub now_j: f64,
    /// Its largest value in this impact, J.
    pub impact_j: f64,
    /// Sum of the largest values in the impacts before, J.
    pub before_j: f64,
    /// Part of its fracture energy that the impacts before have taken: see
    /// [`dem_physics::breakage::damage`].
    pub damage: f64,
}

/// All clumps. Their spheres are the last of the particles, in the same order.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Clumps {
    /// Shapes: those of the model, then those of fragments.
    #[serde(skip)]
    pub templates: Vec<Arc<Template>>,
    /// Existing clumps.
    pub all: Vec<Clump>,
    /// Their spheres that are near a wall or a particle, particle numbers in ascending order: only
    /// these are updated in every step. The others are updated on demand.
    pub near: Vec<u32>,
}

impl Template {
    /// Pose of the sphere with this number for this pose of the clump: position, radius and
    /// rotation. The radius is not scaled.
    pub fn pose(&self, sphere: usize, clump: &Clump) -> Pose {
        let sphere = &self.spheres[sphere];
        let turned = rotation(clump.turned);
        let [x, y, z] =
            (Vector3::from(clump.place_m) + turned * Vector3::from(sphere.place_m)).into();
        Pose {
            position_m: [x, y, z, sphere.radius_m],
            turned: numbers(&(turned * rotation(sphere.turned))),
        }
    }

    /// Id of the sphere with this number: see [`Particles::id`].
    pub(crate) fn id(&self, sphere: usize, clump: &Clump) -> u32 {
        let of_fragment = self.ids.get(sphere).copied();
        of_fragment.unwrap_or_else(|| clump.first_id + self.file_number[sphere])
    }

    /// How easily contacts move its clumps: where one of their spheres is touched, and where a
    /// plane touches many.
    pub fn landing(&self) -> &Landing {
        self.landing.0.get_or_init(|| {
            let of = |&n: &u32| {
                let sphere = &self.spheres[n as usize];
                (Vector3::from(sphere.place_m), self.scale * sphere.radius_m)
            };
            let body = RigidSpheres {
                mass_kg: self.mass_kg,
                moments_kg_m2: self.moments_kg_m2.into(),
                spheres: self.outer.iter().map(of).collect(),
            };
            body.landing()
        })
    }

    /// The particles that a clump of this template carries, given the first.
    pub(crate) fn spheres_from(&self, first: u32) -> Range<usize> {
        let first = first as usize;
        first..first + self.outer.len()
    }

    /// Inverse mass and inverse mean moment of inertia, 1/kg and 1/(kg m2): the values of each of
    /// its spheres that touches nothing. Contacts share them.
    pub(crate) fn inert(&self) -> [f64; 2] {
        let mean = self.moments_kg_m2.iter().sum::<f64>() / 3.0;
        [1.0 / self.mass_kg, 1.0 / mean]
    }
}

impl Clump {
    /// Whether it sleeps on a surface that carries it along.
    pub(crate) fn rides(&self) -> bool {
        self.asleep && self.velocity_m_s != [0.0; 3]
    }

    /// Spin, rad/s.
    pub fn spin_rad_s(&self, template: &Template) -> Vector3<f64> {
        spin_rad_s(&self.turned, self.angular_momentum, template.moments_kg_m2).into()
    }

    /// Kinetic energy, J.
    pub fn kinetic_j(&self, template: &Template) -> f64 {
        let speed = Vector3::from(self.velocity_m_s).norm_squared();
        0.5 * template.mass_kg * speed
            + kinetic_j(&self.turned, self.angular_momentum, template.moments_kg_m2)
    }

    /// Motion of a sphere of the clump at any position, m.
    pub fn motion(&self, template: &Template) -> impl Fn(&Vector3<f64>) -> Motion + use<> {
        let [centre, velocity] = [self.place_m, self.velocity_m_s].map(Vector3::from);
        let spin = self.spin_rad_s(template);
        let [inverse_mass, inverse_inertia] = template.inert();
        move |place| Motion {
            velocity_m_s: (velocity + spin.cross(&(place - centre))).into(),
            inverse_mass,
            spin_rad_s: spin.into(),
            inverse_inertia,
        }
    }
}

impl Clumps {
    /// Number of clumps of two or more spheres: an inlet also feeds single loose spheres.
    pub fn of_several_spheres(&self) -> usize {
        let several = |clump: &&Clump| self.template(clump).spheres.len() > 1;
        self.all.iter().filter(several).count()
    }

    /// Template of a clump.
    pub fn template(&self, clump: &Clump) -> &Arc<Template> {
        &self.templates[clump.template as usize]
    }

    /// The particles that a clump carries.
    pub fn spheres_of(&self, clump: &Clump) -> Range<usize> {
        self.template(clump).spheres_from(clump.first)
    }

    /// Number of the clump that carries a particle. None: the particle is free.
    pub fn carrier_of(&self, particle: usize) -> Option<usize> {
        let after = self
            .all
            .partition_point(|clump| clump.first as usize <= particle);
        after.checked_sub(1)
    }

    /// Sets the spheres, in ascending order, that are near something, and the range of each clump:
    /// clumps are in the order of their spheres. Returns those that were near before.
    pub(crate) fn set_near(&mut self, near: Vec<u32>) -> Vec<u32> {
        let mut listed = 0;
        for clump in &mut self.all {
            let spheres = self.templates[clump.template as usize].spheres_from(clump.first);
            clump.near = [spheres.start, spheres.end].map(|i| {
                let before = near[listed..]
                    .iter()
                    .take_while(|&&sphere| (sphere as usize) < i);
                listed += before.count();
                listed as u32
            });
        }
        std::mem::replace(&mut self.near, near)
    }

    /// Mass of all clumps, kg.
    pub fn mass_kg(&self) -> f64 {
        self.all
            .iter()
            .map(|clump| self.template(clump).mass_kg)
            .sum()
    }

    /// Kinetic energy of all clumps, J.
    pub fn kinetic_j(&self) -> f64 {
        self.all
            .iter()
            .map(|clump| clump.kinetic_j(self.template(clump)))
            .sum()
    }

    /// Appends the contact spheres of a clump to the particles and records their position in the
    /// clump.
    pub(crate) fn push_spheres(template: &Template, clump: &mut Clump, particles: &mut Particles) {
        clump.first = particles.len() as u32;
        let motion_at = clump.motion(template);
        for &sphere in template.outer.iter() {
            let mut pose = template.pose(sphere as usize, clump);
            pose.position_m[3] *= template.scale;
            particles.motions.push(motion_at(&pose.place()));
            particles.poses.push(pose);
            particles.wrenches.push(Wrench::default());
            particles.ids.push(template.id(sphere as usize, clump));
        }
    }
}

impl Template {
    /// A single sphere of this mass, kg, and radius, m, that is otherwise like a body.
    pub fn sphere(like: &Self, mass_kg: f64, radius_m: f64) -> Self {
        let inertia_kg_m2 = 0.4 * mass_kg * radius_m * radius_m;
        Self {
            body: like.body.clone(),
            mass_kg,
            moments_kg_m2: [inertia_kg_m2; 3],
            axes: [0.0, 0.0, 0.0, 1.0],
            centre_m: [0.0; 3],
            reach_m: radius_m,
            spheres: Arc::new(vec![SubSphere {
                place_m: [0.0; 3],
                turned: [0.0, 0.0, 0.0, 1.0],
                radius_m,
                mass_kg,
                inertia_kg_m2,
            }]),
            outer: Arc::new(vec![0]),
            scale: 1.0,
            material: like.material,
            bonds: Arc::new(Bonds {
                rules: like.bonds.rules.clone(),
                ..Bonds::default()
            }),
            file_number: Arc::new(vec![0]),
            ids: Vec::new(),
            scatter: None,
            bonds_of_file: Arc::default(),
            landing: KnownLanding::default(),
            breaks_from_n_m: f64::INFINITY,
            slender: None,
        }
    }

    /// Mass over the volume of its spheres, overlaps counted twice, kg/m3.
    pub fn sphere_density_kg_m3(&self) -> f64 {
        self.mass_kg / sphere_volume_m3(&self.spheres)
    }

    /// Diameter of the sphere with the volume of its spheres, overlaps counted twice, m.
    pub fn size_m(&self) -> f64 {
        let cubes = self.spheres.iter().map(|sphere| sphere.radius_m.powi(3));
        2.0 * cubes.sum::<f64>().cbrt()
    }

    /// Takes the arrays of another template in place of equal ones, so that they are stored once.
    pub fn share(&mut self, other: &Self) {
        fn share<T: PartialEq>(own: &mut Arc<T>, other: &Arc<T>) {
            if **own == **other {
                *own = Arc::clone(other);
            }
        }
        share(&mut self.spheres, &other.spheres);
        share(&mut self.bonds, &other.bonds);
        share(&mut self.file_number, &other.file_number);
        share(&mut self.bonds_of_file, &other.bonds_of_file);
    }

    /// Bytes of all arrays of some templates, of shared ones once.
    pub(crate) fn bytes_of(templates: &[Arc<Self>]) -> usize {
        let mut counted = BTreeSet::new();
        let arrays = templates.iter().flat_map(|template| template.arrays());
        let once = arrays.filter(|(address, _)| counted.insert(*address));
        let own = templates.iter().map(|t| size_of_val(&t.ids[..]));
        once.map(|(_, bytes)| bytes).chain(own).sum()
    }

    /// Address and bytes of each array that can be shared.
    fn arrays(&self) -> [(usize, usize); 5] {
        fn array<T>(list: &Arc<Vec<T>>) -> (usize, usize) {
            (Arc::as_ptr(list).addr(), size_of_val(&list[..]))
        }
        let bonds = &self.bonds;
        let of_bonds = size_of_val(&bonds.ends[..])
            + size_of_val(&bonds.blocks[..])
            + size_of_val(&bonds.damping[..])
            + bonds.histories.bytes();
        [
            array(&self.spheres),
            array(&self.outer),
            array(&self.file_number),
            array(&self.bonds_of_file),
            (Arc::as_ptr(bonds).addr(), of_bonds),
        ]
    }
}
