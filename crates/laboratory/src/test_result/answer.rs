//! What a test gives, in a sentence.

use dem_io::units::{show_quantity, significant};

use super::{LARGEST_FORCE, LARGEST_FRAGMENT, MODULUS, STIFFNESS, STRENGTH, T10, TestResult};
use crate::figure::Figure;
use crate::specimen::TestType;

impl TestResult {
    /// The result in a sentence without its full stop: strength beside its target, and where the
    /// body broke; of a falling weight the sizes of the fragments; without steps the modulus.
    pub fn answer(&self) -> String {
        let said = match self.kind {
            TestType::DropWeight => self.of_weight(),
            _ if self.rate_m_s == 0.0 => self.of_equilibrium(),
            _ => self.of_strength(),
        };
        said.unwrap_or_else(|| "the test gives no strength".to_owned())
    }

    fn of_weight(&self) -> Option<String> {
        let [broken, _] = self.broken_bonds;
        if broken == 0 {
            return Some("no bond breaks".to_owned());
        }
        let largest = 100.0 * self.figure(LARGEST_FRAGMENT)?;
        let fines = self.figure(T10).map_or(String::new(), |t10| {
            format!(", t10 is {} %", significant(100.0 * t10, 3))
        });
        Some(format!(
            "the largest fragment has {} % of the mass{fines}",
            significant(largest, 3)
        ))
    }

    fn of_equilibrium(&self) -> Option<String> {
        let mut names = [MODULUS, STIFFNESS].into_iter();
        names.find_map(|name| self.named(name)).map(beside_target)
    }

    fn of_strength(&self) -> Option<String> {
        match self.named(STRENGTH) {
            Some(strength) => Some(beside_target(strength) + &self.place()),
            None => self.named(LARGEST_FORCE).map(|force| {
                format!(
                    "the body does not break, the largest load is {}",
                    show_quantity(force.value, &force.unit)
                )
            }),
        }
    }

    /// Where the body broke, after its strength. Empty: no bond broke, or its type of test expects
    /// no place.
    fn place(&self) -> String {
        let Some(crack) = &self.crack else {
            return String::new();
        };
        let is = match self.is_misplaced(crack) {
            Some(false) => "where it should",
            Some(true) => "not where it should",
            None => return String::new(),
        };
        let far = show_quantity(crack.offset_m.abs(), "m");
        format!("; it broke {is}, {far} from the middle")
    }

    fn named(&self, name: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.name == name)
    }
}

/// A figure, and how far it is from its expected value.
fn beside_target(figure: &Figure) -> String {
    let shown = format!(
        "{} {}",
        figure.name,
        show_quantity(figure.value, &figure.unit)
    );
    let (Some(target), Some(error)) = (figure.theory, figure.error) else {
        return shown;
    };
    let side = if error < 0.0 { "below" } else { "above" };
    format!(
        "{shown}, {:.1} % {side} the target of {}",
        100.0 * error.abs(),
        show_quantity(target, &figure.unit)
    )
}
