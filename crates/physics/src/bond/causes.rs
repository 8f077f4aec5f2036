//! How many bonds failed by each criterion.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::criteria::{COUNT, Cause};

/// How many bonds failed by each criterion, in the order of [`Cause::ALL`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CauseCounts([u64; COUNT]);

impl CauseCounts {
    /// Counts one more bond.
    pub fn count(&mut self, cause: Cause) {
        self.0[cause as usize] += 1;
    }

    /// Bonds that failed by this criterion.
    pub fn of(&self, cause: Cause) -> u64 {
        self.0[cause as usize]
    }

    /// Writes the counts by the names of their causes.
    pub fn serialize_by_name<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.named())
    }

    /// Reads counts by the names of their causes; those that are missing are 0.
    pub fn deserialize_by_name<'de, D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let named = BTreeMap::<String, u64>::deserialize(from)?;
        let of = |cause: Cause| named.get(cause.name()).copied().unwrap_or(0);
        Ok(Self(Cause::ALL.map(of)))
    }

    /// The counts with the names of their causes.
    pub fn named(&self) -> [(&'static str, u64); COUNT] {
        Cause::ALL.map(|cause| (cause.name(), self.of(cause)))
    }

    /// The counts that are not 0, with how bonds fail: "in tension".
    pub fn phrased(&self) -> impl Iterator<Item = (&'static str, u64)> {
        let all = Cause::ALL.map(|cause| (cause.phrase(), self.of(cause)));
        all.into_iter().filter(|(_, count)| *count > 0)
    }
}

impl fmt::Display for CauseCounts {
    /// The counts that are not 0: `23 in tension, 2 in shear`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts: Vec<String> = self
            .phrased()
            .map(|(how, count)| format!("{count} {how}"))
            .collect();
        f.write_str(&counts.join(", "))
    }
}
