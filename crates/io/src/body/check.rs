//! The rules for every body, checked whenever one is read or written.

use super::histories;
use super::parts::Body;
use crate::diagnostic::{Diagnostic, Result};

impl Body {
    /// Checks that this is a body: particles with finite centres and positive radii, bonds with
    /// positive radii and lengths between two different existing particles, the smaller index
    /// first, no pair bonded twice, arrays of equal length, no NUL character in its texts.
    ///
    /// Takes linear time and at most 8 bytes of memory per particle and 4 per bond, none if the
    /// bonds are sorted.
    pub fn check(&self) -> Result<()> {
        check_lengths(self)?;
        check_particles(self)?;
        check_bonds(self)?;
        check_about(self)?;
        histories::check_directions(&self.bond_directions)?;
        histories::check(&self.bond_histories, &self.bond_lengths)?;
        check_double_bonds(self)
    }
}

fn check_lengths(body: &Body) -> Result<()> {
    let particles = body.positions.len();
    let bonds = body.bonds.len();
    if particles == 0 {
        return Err(Diagnostic::input(
            "",
            "the body has no particles",
            "a body needs at least one",
        ));
    }
    if u32::try_from(particles).is_err() {
        return Err(Diagnostic::input(
            "",
            format!("{particles} particles; the limit is {}", u32::MAX),
            "split the body",
        ));
    }
    // None: all bonds are intact.
    let given = |count: usize| if count == 0 { bonds } else { count };
    for (what, length, of, wanted) in [
        ("radii", body.radii.len(), "particles", particles),
        ("bond radii", body.bond_radii.len(), "bonds", bonds),
        ("bond lengths", body.bond_lengths.len(), "bonds", bonds),
        (
            "rotations",
            if body.turns_rad.is_empty() {
                particles
            } else {
                body.turns_rad.len()
            },
            "particles",
            particles,
        ),
        (
            "directions of bonds",
            if body.turns_rad.is_empty() {
                given(body.bond_directions.len())
            } else {
                body.bond_directions.len()
            },
            "bonds",
            bonds,
        ),
        (
            "bond damages",
            given(body.bond_damages.len()),
            "bonds",
            bonds,
        ),
    ] {
        if length != wanted {
            return Err(Diagnostic::input(
                "",
                format!("{length} {what} for {wanted} {of}"),
                "there must be one each",
            ));
        }
    }
    Ok(())
}

fn check_particles(body: &Body) -> Result<()> {
    for (particle, (position, &radius)) in body.positions.iter().zip(&body.radii).enumerate() {
        check_particle(position, radius)
            .and_then(|()| check_turn(body.turns_rad.get(particle)))
            .map_err(|error| error.within(&format!("particle {particle}")))?;
    }
    Ok(())
}

fn check_turn(turn_rad: Option<&[f64; 3]>) -> Result<()> {
    if turn_rad.is_none_or(|turn| turn.iter().all(|angle| angle.is_finite())) {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        "its rotation is not finite",
        "correct or remove this particle",
    ))
}

pub(super) fn check_particle(position: &[f64; 3], radius: f64) -> Result<()> {
    for (axis, value) in ["x", "y", "z"].into_iter().zip(position) {
        if !value.is_finite() {
            return Err(Diagnostic::input(
                "",
                format!("{axis} is {value}, but must be a finite number of metres"),
                "correct or remove this particle",
            ));
        }
    }
    check_positive(radius, "radius")
}

fn check_bonds(body: &Body) -> Result<()> {
    let particles = body.positions.len();
    for (bond, &[a, b]) in body.bonds.iter().enumerate() {
        let place = || format!("bond {bond}");
        let largest = a.max(b);
        if largest as usize >= particles {
            return Err(Diagnostic::input(
                place(),
                format!(
                    "it joins particle {largest}, but there are {particles} particles, numbered from 0"
                ),
                "correct or remove this bond",
            ));
        }
        check_different(a, b).map_err(|error| error.within(&place()))?;
        if a > b {
            return Err(Diagnostic::input(
                place(),
                format!("it joins particle {a} to {b}"),
                "the smaller number must stand first",
            ));
        }
        check_positive(body.bond_radii[bond], "radius")
            .and_then(|()| check_positive(body.bond_lengths[bond], "initial length"))
            .and_then(|()| check_damage(body.bond_damages.get(bond)))
            .map_err(|error| error.within(&place()))?;
    }
    Ok(())
}

fn check_damage(damage: Option<&f64>) -> Result<()> {
    match damage {
        Some(damage) if !(0.0..1.0).contains(damage) => Err(Diagnostic::input(
            "",
            format!("its damage is {damage}, but must be at least 0 and below 1"),
            "remove this bond if it is broken",
        )),
        _ => Ok(()),
    }
}

/// Checks that the ends of a bond are different particles, by their numbers in the source.
pub(super) fn check_different(a: u32, b: u32) -> Result<()> {
    if a != b {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        format!("it joins particle {a} to itself"),
        "remove this bond",
    ))
}

pub(super) fn check_positive(value: f64, what: &str) -> Result<()> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        format!("its {what} is {value} m, but must be positive and finite"),
        "correct or remove it",
    ))
}

fn check_about(body: &Body) -> Result<()> {
    let about = &body.about;
    for (what, text) in [("program", &about.program), ("source", &about.source)] {
        if text.as_ref().is_some_and(|text| text.contains('\0')) {
            return Err(Diagnostic::input(
                "",
                format!("the name of the {what} contains a NUL character"),
                "remove it: no file can hold it",
            ));
        }
    }
    let numbers = [
        (
            "particle density",
            about.particle_density_kg_m3,
            f64::MIN_POSITIVE,
        ),
        ("shape volume", about.shape_volume_m3, f64::MIN_POSITIVE),
        ("bond range", about.bond_range, f64::MIN_POSITIVE),
        ("overlap", about.overlap, 0.0),
    ];
    for (what, value, least) in numbers {
        if let Some(value) = value
            && !(value.is_finite() && value >= least)
        {
            let limit = if least > 0.0 {
                "positive"
            } else {
                "zero or positive"
            };
            return Err(Diagnostic::input(
                "",
                format!("the {what} is {value}, but must be {limit} and finite"),
                "correct it or leave it out",
            ));
        }
    }
    Ok(())
}

/// Refuses a pair of particles bonded twice. Every bond must join two existing particles, the
/// smaller index first.
fn check_double_bonds(body: &Body) -> Result<()> {
    if body.bonds.is_sorted_by(|p, q| p < q) {
        return Ok(());
    }
    // Counting sort by the smaller index: the partners of particle a end up in partners[ends[a -
    // 1]..ends[a]].
    let mut ends = vec![0_usize; body.positions.len()];
    for &[a, _] in &body.bonds {
        ends[a as usize] += 1;
    }
    let mut before = 0;
    for end in &mut ends {
        let count = *end;
        *end = before;
        before += count;
    }
    let mut partners = vec![0_u32; body.bonds.len()];
    for &[a, b] in &body.bonds {
        partners[ends[a as usize]] = b;
        ends[a as usize] += 1;
    }
    let mut start = 0;
    for (a, &end) in ends.iter().enumerate() {
        let own = &mut partners[start..end];
        own.sort_unstable();
        if let Some(pair) = own.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(double_bond(body, [a as u32, pair[0]]));
        }
        start = end;
    }
    Ok(())
}

fn double_bond(body: &Body, pair: [u32; 2]) -> Diagnostic {
    let mut same = body
        .bonds
        .iter()
        .enumerate()
        .filter(|(_, bond)| **bond == pair)
        .map(|(number, _)| number);
    let (first, second) = (
        same.next().unwrap_or_default(),
        same.next().unwrap_or_default(),
    );
    Diagnostic::input(
        format!("bond {second}"),
        format!(
            "it joins particles {} and {}, as bond {first} does already",
            pair[0], pair[1]
        ),
        "one pair takes one bond: remove one of the two",
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn pair() -> Body {
        Body {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
            radii: vec![0.5; 3],
            bonds: vec![[0, 1], [1, 2]],
            bond_radii: vec![0.25; 2],
            bond_lengths: vec![1.0; 2],
            bond_damages: Vec::new(),
            ..Body::default()
        }
    }

    /// The error for a good body after `spoil`.
    fn said(spoil: impl FnOnce(&mut Body)) -> String {
        let mut body = pair();
        spoil(&mut body);
        body.check().unwrap_err().to_string()
    }

    #[test]
    fn each_rule_names_place_value_and_limit() {
        pair().check().unwrap();
        assert_eq!(
            said(|b| *b = Body::default()),
            "the body has no particles; a body needs at least one"
        );
        assert_eq!(
            said(|b| b.radii.truncate(2)),
            "2 radii for 3 particles; there must be one each"
        );
        assert_eq!(
            said(|b| b.bond_radii.clear()),
            "0 bond radii for 2 bonds; there must be one each"
        );
        assert_eq!(
            said(|b| b.bond_lengths.push(1.0)),
            "3 bond lengths for 2 bonds; there must be one each"
        );
        assert_eq!(
            said(|b| b.bond_damages.push(0.5)),
            "1 bond damages for 2 bonds; there must be one each"
        );
        assert_eq!(
            said(|b| b.bond_damages = vec![0.5, 1.0]),
            "bond 1: its damage is 1, but must be at least 0 and below 1; remove this bond if it is broken"
        );
        assert_eq!(
            said(|b| b.positions[1][2] = f64::NAN),
            "particle 1: z is NaN, but must be a finite number of metres; correct or remove this particle"
        );
        assert_eq!(
            said(|b| b.radii[2] = 0.0),
            "particle 2: its radius is 0 m, but must be positive and finite; correct or remove it"
        );
        assert_eq!(
            said(|b| b.bonds[1] = [1, 3]),
            "bond 1: it joins particle 3, but there are 3 particles, numbered from 0; correct or remove this bond"
        );
        assert_eq!(
            said(|b| b.bonds[0] = [1, 1]),
            "bond 0: it joins particle 1 to itself; remove this bond"
        );
        assert_eq!(
            said(|b| b.bonds[0] = [1, 0]),
            "bond 0: it joins particle 1 to 0; the smaller number must stand first"
        );
        assert_eq!(
            said(|b| b.bond_radii[1] = -0.5),
            "bond 1: its radius is -0.5 m, but must be positive and finite; correct or remove it"
        );
        assert_eq!(
            said(|b| b.bond_lengths[1] = f64::INFINITY),
            "bond 1: its initial length is inf m, but must be positive and finite; correct or remove it"
        );
        assert_eq!(
            said(|b| b.about.overlap = Some(-0.1)),
            "the overlap is -0.1, but must be zero or positive and finite; correct it or leave it out"
        );
        assert_eq!(
            said(|b| b.about.source = Some("a\0b".to_owned())),
            "the name of the source contains a NUL character; remove it: no file can hold it"
        );
    }

    #[test]
    fn a_double_bond_is_found_wherever_it_stands() {
        let remedy = "one pair takes one bond: remove one of the two";
        assert_eq!(
            said(|b| b.bonds[1] = [0, 1]),
            format!("bond 1: it joins particles 0 and 1, as bond 0 does already; {remedy}")
        );
        let apart = |body: &mut Body| {
            body.bonds = vec![[1, 2], [0, 2], [0, 1], [1, 2]];
            body.bond_radii = vec![0.1; 4];
            body.bond_lengths = vec![1.0; 4];
        };
        assert_eq!(
            said(apart),
            format!("bond 3: it joins particles 1 and 2, as bond 0 does already; {remedy}")
        );
        let mut unsorted = pair();
        unsorted.bonds.reverse();
        unsorted.check().unwrap();
    }
}
