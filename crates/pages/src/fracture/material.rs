//! Bonds of the specimens.

/// Young's modulus of the usual bonds, and of a body of them, Pa.
const BOND_PA: f64 = 12e9;
const BODY_PA: f64 = 21e9;
/// Strength of the usual bonds, Pa, and their fracture energy where they have one, J/m2.
pub(crate) const STRENGTH_PA: f64 = 5e6;
pub(crate) const FRACTURE_ENERGY_J_M2: f64 = 40.0;

/// Density of the usual material, kg/m3.
pub(crate) const DENSITY_KG_M3: f64 = 2650.0;

/// Keys of flat joints of few elements.
pub(crate) const FLAT_JOINT: &str =
    "model=\"flat-joint\",radial_elements=1,circumferential_elements=6,joint_friction=0.6,";

/// A material by its bonds, and what is expected of a body of it, for the pace of the tests.
#[derive(Debug, Clone)]
pub(crate) struct Material {
    pub(crate) name: String,
    /// `[bonds.rock]` as one value.
    pub(crate) bonds: String,
    /// Young's modulus of a body, Pa.
    pub(crate) young_pa: f64,
    /// Strength of the bonds, Pa, and fracture energy, J/m2; 0: none.
    pub(crate) strength_pa: f64,
    pub(crate) fracture_energy_j_m2: f64,
    pub(crate) density_kg_m3: f64,
}

impl Material {
    /// Usual bonds with these keys more, which fail by these ones.
    pub(crate) fn of(name: &str, keys: &str, failure: &str) -> Self {
        Self {
            name: name.to_owned(),
            bonds: format!(
                "{{young_modulus={BOND_PA},poisson_ratio=0.25,{keys}failure={{{failure}}}}}"
            ),
            young_pa: BODY_PA,
            strength_pa: STRENGTH_PA,
            fracture_energy_j_m2: 0.0,
            density_kg_m3: DENSITY_KG_M3,
        }
    }

    pub(crate) fn brittle() -> Self {
        Self::of("brittle", "", &format!("tensile_strength={STRENGTH_PA}"))
    }

    /// Bonds that soften.
    pub(crate) fn cohesive() -> Self {
        let failure =
            format!("tensile_strength={STRENGTH_PA},fracture_energy={FRACTURE_ENERGY_J_M2}");
        Self {
            fracture_energy_j_m2: FRACTURE_ENERGY_J_M2,
            ..Self::of(&format!("{FRACTURE_ENERGY_J_M2} J/m2"), "", &failure)
        }
    }

    /// Bonds of this modulus, Pa, fracture energy, J/m2 (0: they are brittle), and tensile strength,
    /// Pa, of a body of this modulus, Pa, and density, kg/m3.
    pub(crate) fn tensile(bonds: [f64; 3], young_pa: f64, density_kg_m3: f64) -> Self {
        let [bond_pa, energy_j_m2, tensile_pa] = bonds;
        let mut failure = format!("tensile_strength={tensile_pa:.4e}");
        if energy_j_m2 > 0.0 {
            failure += &format!(",fracture_energy={energy_j_m2:.4e}");
        }
        Self {
            name: format!("{bond_pa:.3e} {energy_j_m2:.3e} {tensile_pa:.3e}"),
            bonds: format!(
                "{{young_modulus={bond_pa:.4e},poisson_ratio=0.25,failure={{{failure}}}}}"
            ),
            young_pa,
            strength_pa: tensile_pa,
            fracture_energy_j_m2: energy_j_m2,
            density_kg_m3,
        }
    }

    /// Toughness that is expected with spheres of this diameter, m: Pa sqrt(m).
    pub(crate) fn toughness(&self, diameter_m: f64) -> f64 {
        let brittle = self.strength_pa * (3.1 * diameter_m).sqrt();
        let cohesive = (2.4 * self.young_pa * self.fracture_energy_j_m2).sqrt();
        brittle.max(cohesive)
    }

    /// Speed of sound along a bar of it, m/s.
    pub(crate) fn speed_m_s(&self) -> f64 {
        (self.young_pa / self.density_kg_m3).sqrt()
    }

    /// Its name as a part of one of a file.
    pub(crate) fn file_name(&self) -> String {
        self.name.replace([' ', ',', '/'], "-")
    }
}
