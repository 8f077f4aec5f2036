//! Several lanes give the same bits as one.

use super::avx2::Lanes4;
use super::avx512::Lanes8;
use super::{Lanes, MOST};
use crate::contact::kinematics::{
    ContactKinematics, ContactSphere, WallPoint, contact_kinematics, wall_contact_kinematics,
};
use crate::contact::law::hertz_mindlin::HertzMindlin;
use crate::contact::law::linear::Linear;
use crate::contact::pair_parameters::PairParameters;
use crate::contact::relaxation::relaxed;
use crate::contact::rolling::{ConstantMoment, ElasticPlastic, NoRolling, RollingFriction};
use crate::contact::{ContactSprings, Response, response};
use crate::number::Vec3;
use proptest::prelude::*;

/// Columns of data of a contact.
const COLUMNS: usize = 40;
const DT: f64 = 1e-6;

/// Numbers of one contact or several, taken in sequence.
struct Taken<'a, T: Lanes> {
    proof: T::Proof,
    columns: &'a [[f64; MOST]],
    first: usize,
    next: usize,
}

impl<T: Lanes> Taken<'_, T> {
    fn number(&mut self, scale: f64) -> T {
        let number = T::load(self.proof, &self.columns[self.next], self.first);
        self.next += 1;
        number.scale(scale)
    }

    fn triple(&mut self, scale: f64) -> Vec3<T> {
        Vec3(self.number(scale), self.number(scale), self.number(scale))
    }

    fn contact_sphere(&mut self) -> ContactSphere<T> {
        ContactSphere {
            velocity_m_s: self.triple(1.0),
            spin_rad_s: self.triple(50.0),
            radius_m: self.number(0.001).plus(0.01),
            inverse_mass_per_kg: self.number(10.0).plus(100.0),
            inverse_inertia_per_kg_m2: self.number(1e5).plus(1e6),
        }
    }
}

fn written<T: Lanes>(response: &Response<T>, to: &mut Vec<[f64; MOST]>) {
    let damping = &response.damping;
    for Vec3(x, y, z) in [
        response.springs.tangential_m,
        response.springs.rolling_rad,
        response.force_on_b,
        response.moment_on_b,
        damping.normal_n,
        damping.tangential_n,
        damping.rolling_n_m,
    ] {
        to.extend([x, y, z].map(T::values));
    }
    let (energy, lost) = (&response.energy, &response.lost);
    for number in [
        response.springs.overlap_m,
        energy.normal,
        energy.tangential,
        energy.rolling,
        lost.sliding,
        lost.rolling,
    ] {
        to.push(number.values());
    }
}

fn add<T: Lanes>(
    (hertz, linear): (&HertzMindlin<T>, &Linear<T>),
    rolling: &impl RollingFriction<T>,
    touch: &ContactKinematics<T>,
    history: &ContactSprings<T>,
    to: &mut Vec<[f64; MOST]>,
) {
    written(&response(hertz, rolling, touch, history, DT), to);
    written(&response(linear, rolling, touch, history, DT), to);
}

/// All results of the contact laws for the contacts from `first` on.
fn answers<T: Lanes>(proof: T::Proof, columns: &[[f64; MOST]], first: usize) -> Vec<[f64; MOST]> {
    let mut taken = Taken::<T> {
        proof,
        columns,
        first,
        next: 0,
    };
    let (a, b) = (taken.contact_sphere(), taken.contact_sphere());
    let Vec3(x, y, z) = taken.triple(0.2);
    let normal = Vec3(x, y, z.plus(1.0));
    let normal = normal * normal.square().sqrt().inverse();
    let overlap = taken.number(1e-5);
    let history = ContactSprings {
        tangential_m: taken.triple(1e-6),
        rolling_rad: taken.triple(1e-4),
        overlap_m: taken.number(1e-5).maximum(overlap.scale(0.0)),
    };
    let friction = taken.number(0.2).plus(0.3);
    let zero = friction.scale(0.0);
    let parameters = PairParameters {
        damping_ratio: friction,
        tangential_damping_ratio: friction,
        friction,
        least_n: zero,
        kept: [zero, zero.plus(1.0)],
    };
    let hertz = HertzMindlin {
        young_modulus_pa: friction.scale(1e9),
        shear_modulus_pa: friction.scale(5e8),
        parameters,
    };
    let linear = Linear {
        normal_n_m: friction.scale(1e6),
        tangential_n_m: friction.scale(8e5),
        parameters,
    };
    let apart = normal * (a.radius_m + b.radius_m - overlap);
    let foot = WallPoint {
        normal,
        normal_before: normal,
        distance_m: b.radius_m - overlap,
        velocity_m_s: a.velocity_m_s,
        spin_rad_s: a.spin_rad_s,
    };
    let mut found = Vec::new();
    for touch in [
        contact_kinematics(apart, [a, b], DT),
        wall_contact_kinematics(&foot, b, DT),
    ] {
        let spring = ElasticPlastic {
            friction,
            damping_ratio: friction,
        };
        let laws = (&hertz, &linear);
        add(laws, &NoRolling, &touch, &history, &mut found);
        add(
            laws,
            &ConstantMoment { friction },
            &touch,
            &history,
            &mut found,
        );
        add(laws, &spring, &touch, &history, &mut found);
    }
    let relaxed = relaxed(overlap, history.overlap_m, friction.scale(1e-6));
    found.extend([relaxed.overlap_m, relaxed.origin_m].map(T::values));
    found
}

/// Whether these lanes give the same bits as one.
fn compare<T: Lanes>(proof: T::Proof, columns: &[[f64; MOST]]) -> Result<(), TestCaseError> {
    for first in (0..MOST).step_by(T::COUNT) {
        let at_once = answers::<T>(proof, columns, first);
        for lane in 0..T::COUNT {
            let alone = answers::<f64>((), columns, first + lane);
            prop_assert_eq!(at_once.len(), alone.len());
            for (several, one) in at_once.iter().zip(&alone) {
                prop_assert_eq!(several[lane].to_bits(), one[0].to_bits());
            }
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn contacts_at_once_give_the_bits_of_one_by_one(
        columns in prop::collection::vec(prop::array::uniform8(-1.0..1.0_f64), COLUMNS),
    ) {
        if let Some(simd) = pulp::x86::V3::try_new() {
            compare::<Lanes4>(simd, &columns)?;
        }
        if let Some(simd) = pulp::x86::V4::try_new() {
            compare::<Lanes8>(simd, &columns)?;
        }
    }

    #[test]
    fn rows_become_columns_and_rows_again(
        rows in prop::array::uniform8(prop::array::uniform4(-1.0..1.0_f64)),
    ) {
        if let Some(simd) = pulp::x86::V3::try_new() {
            turn_over::<Lanes4>(simd, &rows)?;
        }
        if let Some(simd) = pulp::x86::V4::try_new() {
            turn_over::<Lanes8>(simd, &rows)?;
        }
    }
}

fn turn_over<T: Lanes>(proof: T::Proof, rows: &[[f64; 4]; MOST]) -> Result<(), TestCaseError> {
    let columns = T::columns(proof, |lane| rows[lane]);
    for (k, column) in columns.into_iter().enumerate() {
        for (value, row) in column.values().iter().zip(&rows[..T::COUNT]) {
            prop_assert_eq!(*value, row[k]);
        }
    }
    prop_assert_eq!(&T::rows(columns)[..T::COUNT], &rows[..T::COUNT]);
    Ok(())
}
