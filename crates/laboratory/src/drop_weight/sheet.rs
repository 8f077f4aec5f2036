//! Drop-weight tests, as sheets give them.

/// A row of a sheet: specimens of one size, struck with one energy.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DropWeightTest {
    /// File and line.
    pub place: String,
    /// Size of the specimens, m.
    pub size_m: f64,
    /// Energy over mass, J/kg.
    pub energy_j_kg: f64,
    /// Part of the mass of all specimens that passes a tenth of their size. None: not measured.
    pub t10: Option<f64>,
    /// n and t_n of the others of the family.
    pub family: Vec<[f64; 2]>,
    /// Number of specimens, and of those that broke. None: not measured.
    pub broken: Option<[f64; 2]>,
}

/// The tests of an ore.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DropWeightSheets {
    /// Names of the files.
    pub files: Vec<String>,
    /// Their rows.
    pub tests: Vec<DropWeightTest>,
    /// Name of the ore; empty: the sheets give none.
    pub ore: String,
    /// What was assumed or not read, a sentence each.
    pub notes: Vec<String>,
}
