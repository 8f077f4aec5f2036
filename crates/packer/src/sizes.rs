//! Particle sizes: the user's text as a distribution function by number and by mass.
//!
//! | text | distribution of the diameter |
//! |---|---|
//! | `2.5mm` | one size |
//! | `2mm..3mm`, `uniform:2mm..3mm` | every size between the two equally often |
//! | `normal:MEAN,STD,MIN..MAX` | normal, cut at MIN and MAX |
//! | `lognormal:MEAN,STD,MIN..MAX` | lognormal, cut; mean and standard deviation of the diameter itself, not of its logarithm |
//! | `weibull:SCALE,SHAPE,MIN..MAX`, `rosin-rammler:...` | F(d) = 1 - exp(-(d/SCALE)^SHAPE), cut |
//! | `sieve:FILE.csv`, `FILE.csv` | opening and cumulative passing, linear between the openings |
//!
//! MEAN, STD, SCALE and SHAPE describe the complete distribution, before it is cut. Without
//! MIN..MAX it is cut at its 0.1 % and 99.9 % quantiles. The distribution counts particles or their
//! mass, see [`Basis`]; the two are converted into each other with the third power of the diameter.

mod curve;
mod distribution;
mod fit;
mod laws;
mod parse;

pub use self::curve::Curve;
pub use self::distribution::Sizes;
pub use self::fit::{Fit, ks_distance_by_mass, ks_distance_by_number};
pub use self::laws::Basis;
pub use dem_io::sieve_curve::{SieveCurve, parse as parse_sieve_curve};
