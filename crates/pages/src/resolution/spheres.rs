//! Lumps of spheres of one size, turned in some way.

use std::f64::consts::TAU;
use std::path::PathBuf;

use dem_io::Body;
use dem_io::body::{read_body, write_body};
use dem_pack::cli::thread_pool;
use dem_pack::{BodySettings, PackSettings, make_body};
use nalgebra::{Rotation3, Vector3};

use crate::bench::{Bench, Failed, Run};
use crate::shapes::{shape, sizes};

/// Spheres across the lump and the bar: each size is two thirds of the one before.
pub(super) const ACROSS: [f64; 4] = [4.0, 6.0, 9.0, 13.5];
/// Ratio of one size to the next.
pub(super) const REFINEMENT: f64 = 1.5;
/// Thickness of the lump and of the bar, m, and the scale that gives it to the lump.
pub(super) const THICKNESS_M: f64 = 0.03;
const SCALE: f64 = 1.2;
/// A quarter of the sieve size of the lump, m.
pub(super) const QUARTER_M: f64 = 9e-3;

/// A lump of so many spheres across. Its number is the seed of its packing, and says how it is
/// turned.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lump {
    pub(super) across: f64,
    pub(super) number: u32,
}

/// Mean diameter of spheres of which so many lie across, m.
pub(super) fn diameter_m(across: f64) -> f64 {
    THICKNESS_M / across
}

/// Their diameters, as `dem-pack` takes them.
pub(super) fn diameters(across: f64) -> String {
    let [least, most] = [0.85, 1.15].map(|part| 1e3 * part * diameter_m(across));
    format!("{least:.4}mm..{most:.4}mm")
}

impl Lump {
    pub(super) fn name(self) -> String {
        format!("lump-{}-{}", self.across, self.number)
    }

    /// The turned packing: that of `dem-pack data/shapes/rock.stl --scale 1.2` with its diameters
    /// and its seed. Kept in the folder of a bench.
    pub(super) fn packed(self, bench: Option<&Bench>) -> Result<Body, Failed> {
        let file = bench.map(|bench| self.file(bench));
        if let (Some(bench), Some(file)) = (bench, &file)
            && bench.has(file)
        {
            return Ok(read_body(file)?);
        }
        let packing = PackSettings {
            seed: self.number.into(),
            ..PackSettings::new(sizes(&diameters(self.across))?)
        };
        let surface = shape("rock", SCALE)?;
        let settings = BodySettings::new(packing);
        let made = thread_pool(Some(1))?.install(|| make_body(&surface, &settings, &|_, _| Ok(())));
        let mut body = made?.0;
        let turn = self.turn();
        for place in &mut body.positions {
            *place = (turn * Vector3::from(*place)).into();
        }
        if let Some(file) = file {
            write_body(&body, &file)?;
        }
        Ok(body)
    }

    pub(super) fn file(self, bench: &Bench) -> PathBuf {
        bench.folder.join(self.name() + ".vtp")
    }

    /// Angles of different numbers are spread evenly.
    fn turn(self) -> Rotation3<f64> {
        let [roll, pitch, yaw] =
            [0.755, 0.570, 0.430].map(|step| TAU * (step * f64::from(self.number)).fract());
        Rotation3::from_euler_angles(roll, pitch, yaw)
    }
}

/// Sieves that a run needs: three diameters of its spheres, which they resolve, and a quarter of
/// the lump.
pub(super) fn sieves(across: f64) -> String {
    let mut sieves_m = [resolved_m(across), QUARTER_M];
    sieves_m.sort_by(f64::total_cmp);
    format!("output.sieves={sieves_m:?}")
}

/// The smallest size that such spheres resolve, m: three diameters.
pub(super) fn resolved_m(across: f64) -> f64 {
    3.0 * diameter_m(across)
}

/// Mass fraction of all fragments that passes a sieve.
pub(super) fn passing(run: &Run, sieve_m: f64) -> Result<f64, Failed> {
    let columns = ["body", "location", "sieve_m", "passing_fraction"];
    for [body, location, opening, fraction] in run.words("distribution.csv", columns)? {
        let is_sieve = (opening.parse::<f64>()? / sieve_m - 1.0).abs() < 1e-6;
        if body == "all" && location == "both" && is_sieve {
            return Ok(fraction.parse()?);
        }
    }
    Err("a run without its sieve".into())
}
