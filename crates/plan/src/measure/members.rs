//! Particles and clumps of each name while bodies are added, removed and replaced.

use dem_scene::Scene;

use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clumps::{Clump, Template};
use dem_engine::state::events::REMOVED;
use dem_engine::state::events::Renumbering;

/// The particles of a set, a body or `all`, including those carried by clumps.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Members {
    /// Its name in the scene.
    pub(super) name: String,
    /// Numbers in the state, ascending.
    pub(super) particles: Vec<u32>,
    /// Whether these are all particles.
    pub(super) are_all: bool,
}

impl Members {
    pub(super) fn new(name: &str, particles: Vec<u32>) -> Self {
        Self {
            name: name.to_owned(),
            particles,
            are_all: false,
        }
    }

    /// Updates the numbers of particles: of all, of bodies by their names, and of sets as far as
    /// their particles still exist.
    pub(super) fn renumber(&mut self, by: &[Renumbering], bodies: &[PlacedBody], state: &State) {
        let named = |name: &String| *name == self.name;
        let templates = &state.clumps.templates;
        if self.name == "all" {
            self.particles = (0..state.particles.len() as u32).collect();
        } else if templates.iter().any(|template| named(&template.body)) {
            let own = bodies.iter().filter(|body| named(&body.name));
            let own = own.flat_map(|body| body.particles.iter().copied().filter(|i| *i != REMOVED));
            let clumps = state.clumps.all.iter();
            let clumps = clumps.filter(|clump| named(&state.clumps.template(clump).body));
            let carried = clumps.flat_map(|clump| state.clumps.spheres_of(clump));
            let carried = carried.map(|i| i as u32);
            self.particles = own.chain(carried).collect();
            self.particles.sort_unstable();
        } else {
            for by in by {
                self.particles.retain_mut(|particle| {
                    *particle = by.particles[*particle as usize];
                    *particle < by.free
                });
            }
        }
        self.are_all = self.particles.len() == state.particles.len();
    }

    /// The free particles among them.
    pub(super) fn free<'a>(&'a self, state: &State) -> impl Iterator<Item = usize> + use<'a> {
        let free = state.particles.free as u32;
        let end = self.particles.partition_point(|&i| i < free);
        self.particles[..end].iter().map(|&i| i as usize)
    }

    /// Its clumps among `clumps`, which are those of the state, perhaps at another moment; with
    /// their templates.
    pub(super) fn clumps<'a>(
        &'a self,
        state: &'a State,
        clumps: &'a [Clump],
    ) -> impl Iterator<Item = (&'a Clump, &'a Template)> + use<'a> {
        let own = clumps
            .iter()
            .filter(|clump| self.particles.binary_search(&clump.first).is_ok());
        own.map(|clump| (clump, &**state.clumps.template(clump)))
    }

    /// For each particle of the state whether it is one of them.
    pub(super) fn marked(&self, state: &State) -> Vec<bool> {
        let mut marks = vec![self.are_all; state.particles.len()];
        for &i in &self.particles {
            marks[i as usize] = true;
        }
        marks
    }
}

pub(super) fn wall_number(scene: &Scene, name: &str) -> Option<usize> {
    scene.walls.keys().position(|wall| wall == name)
}
