//! What loads the body of a dynamic test: two long bars and a striker, or a falling weight.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use crate::factor::Factor;
use crate::listing::Listing;
use crate::run::Run;
use crate::schema::table_schema;
use crate::table::Table;
use crate::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::units::{DENSITY, LENGTH, MASS, STRESS, TIME, VELOCITY, show_quantity, significant};

/// Rise of a pulse without a rise time, as a fraction of its duration.
const STEEP: f64 = 1e-6;

table_schema! {
    /// The incident and the transmission bar, which are alike and so long that nothing comes back
    /// from their far ends during the test.
    pub(crate) static BARS = "Bars";

    /// Density.
    quantity("density", &DENSITY).positive().required("\"7850 kg/m3\"");
    /// Young's modulus.
    quantity("young_modulus", &STRESS).positive().required("\"210 GPa\"");
    /// Diameter.
    quantity("diameter", &LENGTH).positive().required("\"20 mm\"");
    /// Distance of the strain gauge on each bar from the end at the body, for `gauge-signals.csv`;
    /// requires `length`.
    quantity("gauge_distance", &LENGTH).positive().otherwise("no gauges");
    /// Length of each bar; only with `gauge_distance`.
    quantity("length", &LENGTH).positive().sometimes_required("\"3 m\"");
}

table_schema! {
    /// The bar of the same kind that strikes the incident bar.
    pub(crate) static STRIKER = "Striker";

    /// Length; the pulse lasts twice the time that a wave takes along it.
    quantity("length", &LENGTH).positive().required("\"200 mm\"");
    /// Velocity of the impact.
    quantity("velocity", &VELOCITY).positive().required("\"10 m/s\"");
    /// Time in which the pulse rises, and falls again, linearly; a pulse shaper makes it longer.
    quantity("rise_time", &TIME).not_negative().or(0.0);
}

table_schema! {
    /// The falling weight. It moves along `direction` without rotating.
    pub(crate) static WEIGHT = "Weight";

    /// Mass.
    quantity("mass", &MASS).positive().required("\"5 kg\"");
    /// Height of the fall; requires `run.gravity` along `direction`.
    quantity("height", &LENGTH).positive().sometimes_required("\"0.5 m\", or velocity = \"3 m/s\"");
    /// Velocity of the impact, instead of a height.
    quantity("velocity", &VELOCITY).positive().otherwise("that of the fall");
}

/// Wave speeds of any solid that bars are made of.
const WAVE_SPEEDS_M_S: RangeInclusive<f64> = 100.0..=20_000.0;

/// Two long elastic bars, and the striker.
#[derive(Debug, Clone, PartialEq)]
pub struct Bars {
    /// `transmission_bar`: the wall, or for tension the group, at the end of the bar behind the
    /// body.
    pub transmission: String,
    /// `density`, kg/m3.
    pub density_kg_m3: f64,
    /// `young_modulus`, Pa.
    pub young_modulus_pa: f64,
    /// `diameter`, m.
    pub diameter_m: f64,
    /// `length` of the striker, m.
    pub striker_m: f64,
    /// `velocity` of the striker, m/s.
    pub striker_m_s: f64,
    /// `rise_time` of the pulse, s; at most its duration.
    pub rise_time_s: f64,
    /// Strain gauges. None: there are none.
    pub gauges: Option<Gauges>,
}

/// A strain gauge on each bar, past which no two pulses go at the same time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gauges {
    /// `gauge_distance` from the end of the bar at the body, m.
    pub distance_m: f64,
    /// `length` of the bar, m.
    pub bar_m: f64,
}

impl Bars {
    /// Speed of a wave along a bar, m/s: sqrt(E/rho).
    pub fn wave_speed_m_s(&self) -> f64 {
        (self.young_modulus_pa / self.density_kg_m3).sqrt()
    }

    /// Section of a bar, m2.
    pub fn area_m2(&self) -> f64 {
        0.25 * PI * self.diameter_m * self.diameter_m
    }

    /// Impedance of a bar, the ratio of force to velocity in a wave, N s/m: rho c A.
    pub fn impedance_n_s_m(&self) -> f64 {
        self.density_kg_m3 * self.wave_speed_m_s() * self.area_m2()
    }

    /// Velocity of the particles of the bar in the incident pulse, m/s: half of the striker's.
    pub fn incident_m_s(&self) -> f64 {
        0.5 * self.striker_m_s
    }

    /// Duration of the pulse at half of its height, s: 2 L/c of the striker.
    pub fn pulse_s(&self) -> f64 {
        2.0 * self.striker_m / self.wave_speed_m_s()
    }

    /// Time after which the pulse is over, s; it begins at time 0.
    pub fn pulse_end_s(&self) -> f64 {
        self.pulse_s() + self.rise_s()
    }

    /// The incident pulse over time, relative to [`Bars::incident_m_s`]: it rises, stays and falls.
    pub fn pulse(&self) -> Factor {
        let (rise_s, pulse_s) = (self.rise_s(), self.pulse_s());
        let mut points = vec![[0.0, 0.0], [rise_s, 1.0]];
        if pulse_s > rise_s {
            points.push([pulse_s, 1.0]);
        }
        points.push([pulse_s + rise_s, 0.0]);
        Factor::Table(points)
    }

    fn rise_s(&self) -> f64 {
        self.rise_time_s.max(STEEP * self.pulse_s())
    }
}

/// A falling weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Weight {
    /// `mass`, kg.
    pub mass_kg: f64,
    /// `height` of the fall, m. None: the velocity is given.
    pub height_m: Option<f64>,
    /// `velocity` of the impact, m/s: sqrt(2 g h) unless given.
    pub velocity_m_s: f64,
    /// Acceleration by `run.gravity` along the direction of the test, m/s2.
    pub gravity_m_s2: f64,
}

pub(super) fn bars(test: &Table<'_>, transmission: String) -> Result<Bars> {
    let (bars, striker) = (test.need("bars")?, test.need("striker")?);
    let (bars, of_striker) = (Table::of(&bars, &BARS)?, Table::of(&striker, &STRIKER)?);
    refuse_unequal(&bars)?;
    let found = Bars {
        transmission,
        density_kg_m3: bars.read("density")?,
        young_modulus_pa: bars.read("young_modulus")?,
        diameter_m: bars.read("diameter")?,
        striker_m: of_striker.read("length")?,
        striker_m_s: of_striker.read("velocity")?,
        rise_time_s: of_striker.read("rise_time")?,
        gauges: None,
    };
    let speed_m_s = found.wave_speed_m_s();
    if !WAVE_SPEEDS_M_S.contains(&speed_m_s) {
        let modulus = bars.need("young_modulus")?;
        let limit = format!(
            "such that sqrt(E/rho), the wave speed of the bars, is {} m/s to {} m/s, and not {} m/s",
            WAVE_SPEEDS_M_S.start(),
            WAVE_SPEEDS_M_S.end(),
            significant(speed_m_s, 3)
        );
        return Err(modulus.wrong(&limit, "check the units of density and young_modulus"));
    }
    if found.rise_time_s > found.pulse_s() {
        let rise = of_striker.need_such("rise_time", "\"0 s\"")?;
        let limit = format!(
            "at most {}, the duration 2 L/c of the pulse",
            show_quantity(found.pulse_s(), "s")
        );
        return Err(rise.wrong(&limit, "take a shorter rise or a longer striker"));
    }
    let gauges = gauges(&bars, found.pulse_end_s() * found.wave_speed_m_s())?;
    Ok(Bars { gauges, ..found })
}

/// Most lengths of a pulse between a strain gauge and the body: the record has rows for all of it.
const MOST_PULSES: f64 = 1000.0;

/// Strain gauges of bars with pulses of this length, m. Refuses a gauge that is nearer than half
/// of it to an end, where the tail of a pulse meets the head of its reflection.
fn gauges(bars: &Table<'_>, pulse_m: f64) -> Result<Option<Gauges>> {
    let Some(distance) = bars.get("gauge_distance") else {
        return match bars.get("length") {
            Some(length) => {
                let problem = "is for strain gauges, but there are none";
                Err(length.fault(problem, "add gauge_distance = \"1 m\", or remove it"))
            }
            None => Ok(None),
        };
    };
    let found = Gauges {
        distance_m: bars
            .read::<Option<f64>>("gauge_distance")?
            .unwrap_or_default(),
        bar_m: bars.read("length")?,
    };
    let half_m = 0.5 * pulse_m;
    let half = show_quantity(half_m, "m");
    let why = |pulses: &str| {
        format!(
            "half the length 2 L + c rise_time of a pulse, {half}: {pulses} would overlap at the gauge"
        )
    };
    if found.distance_m < half_m {
        let limit = format!("at least {}", why("the incident and the reflected pulse"));
        let remedy = "move the gauge away from the body, or take a shorter striker or rise";
        return Err(distance.wrong(&limit, remedy));
    }
    let most_m = MOST_PULSES * pulse_m;
    if found.distance_m > most_m {
        let limit = format!(
            "at most {MOST_PULSES} pulses, {}",
            show_quantity(most_m, "m")
        );
        return Err(distance.wrong(&limit, "move the gauge towards the body"));
    }
    if found.bar_m - found.distance_m < half_m {
        let limit = format!(
            "shorter than the bar by at least {}",
            why("a pulse and what comes back from the far end")
        );
        let remedy =
            "move the gauge towards the body, or take longer bars, a shorter striker or rise";
        return Err(distance.wrong(&limit, remedy));
    }
    Ok(Some(found))
}

/// Refuses a list of the values of two bars.
fn refuse_unequal(bars: &Table<'_>) -> Result<()> {
    let mut given = bars.given(&["density", "young_modulus", "diameter"]);
    match given.find(|(_, field)| matches!(field.node.value, Value::List(_))) {
        Some((_, field)) => {
            let remedy = "two unequal bars cannot be tested with: write one value";
            Err(field.wrong("one value, as both bars are alike", remedy))
        }
        None => Ok(()),
    }
}

pub(super) fn weight(test: &Table<'_>, direction: [f64; 3], run: &Run) -> Result<Weight> {
    let field = test.need("weight")?;
    let table = Table::of(&field, &WEIGHT)?;
    let gravity_m_s2 = (0..3).map(|k| run.gravity_m_s2[k] * direction[k]).sum();
    let mass_kg = table.read("mass")?;
    if let Some(velocity) = table.get("velocity") {
        if let Some(height) = table.get("height") {
            let problem = format!("cannot be combined with {}", velocity.path);
            return Err(height.fault(problem, "the one gives the other: remove one"));
        }
        return Ok(Weight {
            mass_kg,
            height_m: None,
            velocity_m_s: table.read::<Option<f64>>("velocity")?.unwrap_or(0.0),
            gravity_m_s2,
        });
    }
    let height_m: f64 = table.read("height")?;
    if gravity_m_s2 <= 0.0 {
        let height = table.need("height")?;
        let problem = format!(
            "needs run.gravity along test.direction, but that is {} there",
            show_quantity(gravity_m_s2, "m/s2")
        );
        let remedy = "set run.gravity, such as [0, 0, -9.81], turn direction, or write velocity";
        return Err(height.fault(problem, remedy));
    }
    Ok(Weight {
        mass_kg,
        height_m: Some(height_m),
        velocity_m_s: (2.0 * gravity_m_s2 * height_m).sqrt(),
        gravity_m_s2,
    })
}

pub(super) fn list_bars(bars: &Bars, listing: &mut Listing) {
    listing.text("transmission_bar", &bars.transmission);
    listing.table("bars", &BARS, |listing| {
        listing.value("density", &bars.density_kg_m3);
        listing.value("young_modulus", &bars.young_modulus_pa);
        listing.value("diameter", &bars.diameter_m);
        if let Some(gauges) = &bars.gauges {
            listing.value("gauge_distance", &gauges.distance_m);
            listing.value("length", &gauges.bar_m);
        }
    });
    listing.table("striker", &STRIKER, |listing| {
        listing.value("length", &bars.striker_m);
        listing.value("velocity", &bars.striker_m_s);
        listing.value("rise_time", &bars.rise_time_s);
    });
}

pub(super) fn list_weight(weight: &Weight, listing: &mut Listing) {
    listing.table("weight", &WEIGHT, |listing| {
        listing.value("mass", &weight.mass_kg);
        match &weight.height_m {
            Some(height_m) => listing.value("height", height_m),
            None => listing.value("velocity", &weight.velocity_m_s),
        }
    });
}
