//! The numbers that a test gives.

use serde::{Deserialize, Serialize};

/// Where the expected value of a figure comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// The scene gives it, or the number from which it follows.
    Target,
    /// It was measured (`test.measured`).
    Measured,
    /// A closed form.
    ClosedForm,
}

impl Source {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Target => "target",
            Self::Measured => "target (measured)",
            Self::ClosedForm => "closed form",
        }
    }
}

/// A number of a test, and its expected value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit; empty for plain numbers.
    pub unit: String,
    /// Expected value.
    pub theory: Option<f64>,
    /// (value - theory)/|theory|.
    pub error: Option<f64>,
    /// Where the expected value comes from. None: there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theory_is: Option<Source>,
}

impl Figure {
    /// Without an expected value (`theory`), or with that of the scene.
    pub fn new(name: &str, value: f64, unit: &str, theory: Option<f64>) -> Self {
        Self {
            name: name.to_owned(),
            value,
            unit: unit.to_owned(),
            theory,
            error: theory.map(|theory| (value - theory) / theory.abs()),
            theory_is: theory.map(|_| Source::Target),
        }
    }

    /// The figure with another source of its expected value, if it has one.
    pub fn by(self, source: Source) -> Self {
        let theory_is = self.theory_is.map(|_| source);
        Self { theory_is, ..self }
    }
}
