//! The input script.

use std::fmt::Write;

use dem_scene::Scene;

use super::bonds::BondTypes;
use super::clumps::has_bodies;
use super::contacts::Contacts;
use super::data::{atom, lone_spheres};
use super::duration::{frame_every, step_s, steps};
use super::feeds::Feed;
use super::files::{BONDS, BROKEN, CLUMPS, DATA, FRAMES, TYPES};
use super::forces::Forces;
use super::walls::WrittenWall;
use super::words::numbers;
use dem_plan::Plan;

/// What the script is written from.
pub(super) struct Input<'a> {
    pub scene: &'a Scene,
    pub plan: &'a Plan,
    pub types: &'a BondTypes,
    pub contacts: &'a Contacts,
    pub walls: &'a [WrittenWall],
    pub forces: &'a Forces,
    pub feeds: &'a [Feed],
}

/// The law of particles that never meet.
const NO_LAW: &str = "hooke 0.0 1.0 tangential linear_nohistory 0.0 0.0 damping velocity";
/// Ids on a line of a group.
const IDS_PER_LINE: usize = 16;

impl Input<'_> {
    /// The script.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        self.add_begin(&mut text);
        self.add_interactions(&mut text);
        self.add_groups(&mut text);
        self.add_motion(&mut text);
        self.add_loads(&mut text);
        self.add_walls(&mut text);
        // A fix that holds particles comes after all that push them.
        self.add_supports(&mut text);
        self.add_output(&mut text);
        self.add_runs(&mut text);
        text
    }

    pub(super) fn line(text: &mut String, line: impl std::fmt::Display) {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{line}");
    }

    fn add_begin(&self, text: &mut String) {
        for line in [
            "# Written by dem-run export lammps; README.md says what is carried over and what is not.",
            "# mpirun -np N lmp -in in.lammps",
            "units si",
        ] {
            Self::line(text, line);
        }
        self.add_version(text);
        for line in [
            "atom_style bpm/sphere",
            "atom_modify map array",
            "dimension 3",
            "boundary m m m",
            "newton on off",
            "comm_modify vel yes",
        ] {
            Self::line(text, line);
        }
        // Neighbours within the longest bond are known, on other ranks too.
        Self::line(text, format!("comm_modify cutoff {:e}", self.reach_m()));
        Self::line(text, format!("read_data {DATA}"));
        if !self.types.types.is_empty() {
            let breaks = if self.types.break_at_all() {
                "yes"
            } else {
                "no"
            };
            let stored = if self.types.break_at_all() {
                format!(
                    " store/local broken {} time id1 id2 x y z",
                    frame_every(self.scene, self.plan)
                )
            } else {
                String::new()
            };
            // Without pair forces between bonded particles, and with them once their bond is
            // broken.
            Self::line(text, "special_bonds lj 0.0 1.0 1.0 coul 1.0 1.0 1.0");
            Self::line(
                text,
                format!("bond_style bpm/rotational smooth no break {breaks}{stored}"),
            );
            Self::line(text, format!("include {TYPES}"));
        }
    }

    /// Distance at which particles must be known to another rank, m: one and a half times the
    /// longest bond, two diameters, or the width of a clump.
    fn reach_m(&self) -> f64 {
        let state = &self.plan.state;
        let lengths = (0..state.bonds.len()).map(|at| state.bonds.initial_length_m(at));
        let longest = lengths.fold(0.0, f64::max);
        let clumps = state
            .clumps
            .templates
            .iter()
            .map(|template| 2.0 * template.reach_m);
        let widest = clumps.fold(4.0 * state.largest_radius_m(), f64::max);
        (1.5 * longest).max(widest)
    }

    fn add_interactions(&self, text: &mut String) {
        let largest = self.plan.state.largest_radius_m();
        if self.contacts.laws.is_empty() {
            Self::line(text, format!("pair_style zero {:e}", 2.0 * largest));
            Self::line(text, "pair_coeff * *");
        } else {
            Self::line(text, "pair_style granular");
            self.add_laws(text);
        }
        let skin = self.plan.state.smallest_radius_m() * 0.2;
        Self::line(text, format!("neighbor {skin:e} bin"));
        Self::line(text, "neigh_modify every 1 delay 0 check yes");
    }

    /// The law of each pair of types, also of those that never meet: LAMMPS asks for all. Each
    /// material is a type, and each body that is fed.
    fn add_laws(&self, text: &mut String) {
        let fed = self.feeds.iter().map(|feed| feed.material);
        let materials: Vec<usize> = (0..self.contacts.materials.len()).chain(fed).collect();
        for (a, one) in materials.iter().enumerate() {
            for (b, other) in materials.iter().enumerate().skip(a) {
                let both = [*one.min(other), *one.max(other)];
                let law = self.contacts.laws.iter().find(|(pair, _)| *pair == both);
                let law = law.map_or(NO_LAW, |(_, law)| law);
                Self::line(text, format!("pair_coeff {} {} {law}", a + 1, b + 1));
            }
        }
    }

    /// Whether `fix rigid/small` moves anything, now or later.
    fn has_rigid(&self) -> bool {
        has_bodies(&self.plan.state) || self.feeds.iter().any(|feed| feed.is_clump)
    }

    fn add_groups(&self, text: &mut String) {
        let state = &self.plan.state;
        if has_bodies(state) || !self.feeds.is_empty() {
            let free: Vec<u32> = (0..state.particles.free as u32)
                .chain(lone_spheres(self.plan).into_iter().map(|i| i as u32))
                .collect();
            self.add_group(text, "loose", &free);
            Self::line(text, "group clumps subtract all loose");
            Self::line(text, "neigh_modify exclude molecule/intra clumps");
        }
        for feed in self.feeds {
            Self::line(text, format!("group {} empty", feed.group()));
            if feed.is_clump {
                let exclude = format!("neigh_modify exclude molecule/intra {}", feed.group());
                Self::line(text, exclude);
            }
        }
        for (number, load) in (1..).zip(&self.forces.loads) {
            self.add_group(text, &format!("load_{number}"), &load.particles);
        }
        for (number, support) in (1..).zip(&self.forces.supports) {
            self.add_group(text, &format!("support_{number}"), &support.particles);
        }
        for (number, name) in (1..).zip(&self.contacts.materials) {
            if !self.walls.is_empty() {
                Self::line(
                    text,
                    format!("group material_{number} type {number}    # {name}"),
                );
            }
        }
        if !self.contacts.laws.is_empty() && !self.types.types.is_empty() {
            let whole = self.unbreakable();
            if !whole.is_empty() {
                self.add_group(text, "unbreakable", &whole);
                Self::line(text, "neigh_modify exclude molecule/intra unbreakable");
            }
        }
    }

    /// Particles of bodies of one piece whose bonds cannot break.
    fn unbreakable(&self) -> Vec<u32> {
        let state = &self.plan.state;
        let cluster = |i: u32| (state.clusters.as_ref()).map(|c| c.of_particle[i as usize]);
        let whole = self.plan.bodies.iter().filter(|body| {
            let first = body.particles.first().and_then(|i| cluster(*i));
            let is_one = body.particles.iter().all(|i| cluster(*i) == first);
            !body.bonds.is_empty() && is_one && {
                let rule = state.bonds.rule_of(body.first_bond);
                state.bonds.rules[rule].criteria.is_none()
            }
        });
        whole
            .flat_map(|body| body.particles.iter().copied())
            .collect()
    }

    /// A group of these particles of the state.
    fn add_group(&self, text: &mut String, name: &str, particles: &[u32]) {
        let mut atoms: Vec<u64> = particles
            .iter()
            .map(|&i| atom(self.plan, i as usize))
            .collect();
        atoms.sort_unstable();
        let mut ranges: Vec<[u64; 2]> = Vec::new();
        for id in atoms {
            match ranges.last_mut() {
                Some([_, last]) if *last + 1 == id => *last = id,
                _ => ranges.push([id, id]),
            }
        }
        if ranges.is_empty() {
            Self::line(text, format!("group {name} empty"));
        }
        for some in ranges.chunks(IDS_PER_LINE) {
            let words: Vec<String> = (some.iter())
                .map(|[a, b]| {
                    if a == b {
                        format!("{a}")
                    } else {
                        format!("{a}:{b}")
                    }
                })
                .collect();
            Self::line(text, format!("group {name} id {}", words.join(" ")));
        }
    }

    fn add_motion(&self, text: &mut String) {
        let state = &self.plan.state;
        Self::line(
            text,
            format!("timestep {:e}", step_s(self.scene, self.plan)),
        );
        // The bodies of rigid/small have their own gravity.
        let is_parted = has_bodies(state) || !self.feeds.is_empty();
        let mut moving = if is_parted { "loose" } else { "all" };
        let gravity = state.model.gravity_m_s2;
        let size = gravity.iter().map(|x| x * x).sum::<f64>().sqrt();
        if size > 0.0 {
            let [x, y, z] = gravity.map(|g| g / size);
            Self::line(
                text,
                format!("fix gravity {moving} gravity {size:e} vector {x:e} {y:e} {z:e}"),
            );
        }
        if self.has_rigid() {
            self.add_rigid(text, size > 0.0);
        }
        for feed in self.feeds.iter().filter(|feed| !feed.is_clump) {
            let group = feed.group();
            if size > 0.0 {
                let along = numbers(&gravity.map(|g| g / size));
                Self::line(
                    text,
                    format!("fix gravity_{group} {group} gravity {size:e} vector {along}"),
                );
            }
            Self::line(text, format!("fix motion_{group} {group} nve/bpm/sphere"));
        }
        let driven: Vec<usize> = (1..)
            .zip(&self.forces.supports)
            .filter(|(_, support)| support.velocity_m_s.is_some())
            .map(|(number, _)| number)
            .collect();
        if !driven.is_empty() {
            let names: Vec<String> = driven.iter().map(|n| format!("support_{n}")).collect();
            Self::line(
                text,
                format!("group moving subtract {moving} {}", names.join(" ")),
            );
            moving = "moving";
        }
        Self::line(text, format!("fix motion {moving} nve/bpm/sphere"));
    }

    /// Clumps, and the molecules that inlets feed.
    fn add_rigid(&self, text: &mut String, has_gravity: bool) {
        let mut fix = "rigid/small molecule".to_owned();
        if has_gravity {
            fix += " gravity gravity";
        }
        if has_bodies(&self.plan.state) {
            fix += &format!(" infile {CLUMPS}");
        }
        let clumps: Vec<String> = (self.feeds.iter().filter(|feed| feed.is_clump))
            .map(Feed::file)
            .collect();
        if !clumps.is_empty() {
            Self::line(text, format!("molecule fed {}", clumps.join(" ")));
            fix += " mol fed";
        }
        Self::line(text, format!("fix clumps clumps {fix}"));
    }

    /// A `fix deposit` with the molecule of a body: for a clump one of all those of `rigid/small`.
    fn add_feed(&self, text: &mut String, feed: &Feed) {
        Self::line(text, format!("# inlet {}, body {}", feed.inlet, feed.body));
        let group = feed.group();
        let (number, seed) = (feed.number, feed.seed);
        let molecules = if feed.is_clump {
            let clumps = self.feeds.iter().filter(|other| other.is_clump);
            let shares = clumps.map(|other| f64::from(u8::from(other.number == number)));
            let shares = numbers(&shares.collect::<Vec<f64>>());
            format!("mol fed molfrac {shares} rigid clumps")
        } else {
            Self::line(text, format!("molecule sphere_{number} {}", feed.file()));
            format!("mol sphere_{number}")
        };
        Self::line(
            text,
            format!("region inlet_{number} {} units box", feed.region),
        );
        let [x, y, z] = feed.velocity_m_s;
        Self::line(
            text,
            format!(
                "fix feed_{number} {group} deposit {} 0 {} {seed} region inlet_{number} near {:e} {molecules} vx {x:e} {x:e} vy {y:e} {y:e} vz {z:e} {z:e} units box",
                feed.count,
                feed.every,
                2.0 * self.plan.state.largest_radius_m()
            ),
        );
    }

    fn add_loads(&self, text: &mut String) {
        for (number, load) in (1..).zip(&self.forces.loads) {
            Self::line(text, format!("# load {}", load.name));
            for (axis, formula) in ["x", "y", "z"].into_iter().zip(&load.formulas) {
                Self::line(
                    text,
                    format!("variable load_{number}_{axis} equal \"{formula}\""),
                );
            }
            Self::line(
                text,
                format!(
                    "fix load_{number} load_{number} addforce v_load_{number}_x v_load_{number}_y v_load_{number}_z"
                ),
            );
        }
        let damping = self.plan.state.model.particle_damping;
        if damping > 0.0 {
            Self::line(
                text,
                format!("fix damping all damping/cundall {damping:e} {damping:e}"),
            );
        }
    }

    fn add_supports(&self, text: &mut String) {
        for (number, support) in (1..).zip(&self.forces.supports) {
            Self::line(text, format!("# support {}", support.name));
            let name = format!("support_{number}");
            Self::line(
                text,
                match support.velocity_m_s {
                    None => format!("fix {name} {name} freeze"),
                    Some([x, y, z]) => format!("fix {name} {name} move linear {x:e} {y:e} {z:e}"),
                },
            );
        }
    }

    fn add_output(&self, text: &mut String) {
        let every = frame_every(self.scene, self.plan);
        let exact = "%.17g";
        for line in [
            format!(
                "dump frames all custom {every} {FRAMES} id mol type radius x y z vx vy vz omegax omegay omegaz"
            ),
            format!("dump_modify frames sort id time yes format float {exact}"),
        ] {
            Self::line(text, line);
        }
        if !self.types.types.is_empty() {
            Self::line(text, "compute bonds all property/local batom1 batom2 btype");
            Self::line(
                text,
                format!(
                    "dump bonds all local {every} {BONDS} index c_bonds[1] c_bonds[2] c_bonds[3]"
                ),
            );
            // By default LAMMPS writes six digits, and ids may have more.
            let modified = format!("dump_modify bonds time yes format float {exact}");
            Self::line(text, modified);
        }
        if self.types.break_at_all() {
            Self::line(
                text,
                format!(
                    "dump broken all local {every} {BROKEN} f_broken[1] f_broken[2] f_broken[3] f_broken[4] f_broken[5] f_broken[6]"
                ),
            );
            Self::line(text, format!("dump_modify broken format float {exact}"));
        }
        Self::line(text, "thermo_style custom step time atoms");
        Self::line(text, "thermo_modify lost error");
        Self::line(text, format!("thermo {every}"));
    }

    /// The runs: a new one begins where an inlet does.
    fn add_runs(&self, text: &mut String) {
        let mut starts: Vec<u64> = self.feeds.iter().map(|feed| feed.start).collect();
        starts.sort_unstable();
        starts.dedup();
        let mut done = 0;
        for start in starts {
            if start > done {
                Self::line(text, format!("run {}", start - done));
                done = start;
            }
            for feed in self.feeds.iter().filter(|feed| feed.start == start) {
                self.add_feed(text, feed);
            }
        }
        let left = steps(self.scene, self.plan) - done;
        Self::line(text, format!("run {left}"));
    }
}
