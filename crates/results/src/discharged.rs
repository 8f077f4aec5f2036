//! What outlets have taken, read from `discharge.csv`: masses and sieve sizes.

use std::collections::BTreeMap;

use super::growing::fields;

/// Pieces by the size of the smallest sieve that each passes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SievedPieces {
    /// For each piece the size, m, and the mass, kg, in rising order of the sizes.
    pieces: Vec<[f64; 2]>,
}

impl SievedPieces {
    /// From the size, m, and the mass, kg, of each piece.
    pub fn new(mut pieces: Vec<[f64; 2]>) -> Self {
        pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self { pieces }
    }

    /// The size, m, and the mass, kg, of each, in rising order of the sizes.
    pub fn into_pieces(self) -> Vec<[f64; 2]> {
        self.pieces
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.pieces.len()
    }

    /// Their mass, kg.
    pub fn mass_kg(&self) -> f64 {
        self.pieces.iter().map(|[_, mass_kg]| mass_kg).sum()
    }

    /// Mass of the heaviest piece, kg. None: there is no piece.
    pub fn largest_kg(&self) -> Option<f64> {
        let masses_kg = self.pieces.iter().map(|[_, mass_kg]| *mass_kg);
        masses_kg.reduce(f64::max)
    }

    /// Size up to which this fraction of the mass is, m. None: there is no piece.
    pub fn size_m(&self, fraction: f64) -> Option<f64> {
        let wanted_kg = self.mass_kg() * fraction * (1.0 - 1e-12);
        let mut sum_kg = 0.0;
        let reaches = |[_, own_kg]: &&[f64; 2]| {
            sum_kg += own_kg;
            sum_kg >= wanted_kg
        };
        let found = self.pieces.iter().find(reaches).or(self.pieces.last());
        found.map(|[size_m, _]| *size_m)
    }

    /// Fraction of the mass that passes a sieve with this opening, m. None: there is no piece.
    pub fn passing(&self, opening_m: f64) -> Option<f64> {
        let passes = self
            .pieces
            .iter()
            .filter(|[size_m, _]| *size_m <= opening_m);
        let passed_kg: f64 = passes.map(|[_, mass_kg]| mass_kg).sum();
        (!self.pieces.is_empty()).then(|| passed_kg / self.mass_kg())
    }
}

/// The pieces that each outlet has taken, by its name. None: the table has other columns.
pub fn discharged(csv: &str) -> Option<BTreeMap<String, SievedPieces>> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let at = |name: &str| head.iter().position(|column| *column == name);
    let [outlet, sieve, mass] = [at("outlet")?, at("sieve_m")?, at("mass_kg")?];
    let mut outlets: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
    for line in lines {
        let cells = fields(line);
        let number = |at: usize| cells.get(at)?.parse::<f64>().ok();
        let piece = [number(sieve)?, number(mass)?];
        outlets
            .entry(cells.get(outlet)?.clone())
            .or_default()
            .push(piece);
    }
    let sieved = |(name, pieces)| (name, SievedPieces::new(pieces));
    Some(outlets.into_iter().map(sieved).collect())
}
