//! What the colours of spheres tell.

/// What colours tell: those of `output.colour_by` in a scene, and others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourBy {
    /// The fragment.
    Fragment,
    /// The body.
    Body,
    /// Speed of the spheres.
    Speed,
    /// Mass of the fragment.
    FragmentMass,
    /// Largest strain rate of the intact bonds of each sphere.
    StrainRate,
    /// Largest dynamic increase factor of them.
    DynamicIncreaseFactor,
    /// Largest dynamic utilisation of them.
    DynamicUtilisation,
    /// Largest utilisation of the intact bonds of each sphere.
    Utilisation,
    /// Mean normal stress of the intact bonds of each sphere; pressure is negative.
    Stress,
}

impl ColourBy {
    /// Their names.
    pub const WORDS: [(&'static str, Self); 9] = [
        ("fragment", Self::Fragment),
        ("fragment_mass", Self::FragmentMass),
        ("body", Self::Body),
        ("speed", Self::Speed),
        ("utilisation", Self::Utilisation),
        ("stress", Self::Stress),
        ("strain_rate", Self::StrainRate),
        ("dynamic_increase_factor", Self::DynamicIncreaseFactor),
        ("dynamic_utilisation", Self::DynamicUtilisation),
    ];
}
