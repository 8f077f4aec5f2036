//! The quality of the bending sample's packing: the figures given in doc/inside/packing-method.md.

use super::{Bench, Made, root};

fn bending_sample(densify: &[&str]) -> Made {
    let file = root().join("data/shapes/bending-sample.stl");
    let options = ["--diameter", "2mm..3mm", "--overlap", "0", "--unit", "mm"];
    Bench::new().pack(&file, &[&options, densify].concat())
}

#[test]
fn the_bending_sample_is_dense_isotropic_even_and_true_to_its_sizes() {
    let made = bending_sample(&[]);
    let number = |path: &str| made.number(&format!("/quality/{path}"));
    assert!(number("interior_generating_density/value") >= 0.63);
    assert!(number("generating_density") >= 0.595);
    // One packing in 370 of truly random directions deviates more.
    assert!(number("interior_fabric/largest_deviation_in_sigma") < 3.0);
    for by in ["number", "mass"] {
        let off = number(&format!("sizes_by_{by}/distance"));
        assert!(off <= number(&format!("sizes_by_{by}/limit_95")), "{by}");
    }
    // From end to end; each slab has a standard error of about 0.0025.
    let slabs = made.report["quality"]["slab_profile"].as_array().unwrap();
    assert_eq!(slabs.len(), 10);
    for slab in slabs {
        let density = slab["density"]["value"].as_f64().unwrap();
        let off = density - number("interior_generating_density/value");
        assert!(off.abs() < 0.015, "{density}");
    }
    assert_eq!(made.count("/history/removed"), 0);
    assert_eq!(made.count("/history/voids_left"), 0);
}

#[test]
fn settling_makes_it_denser_and_takes_the_preferred_direction_away() {
    let (bare, settled) = (bending_sample(&["--densify", "0"]), bending_sample(&[]));
    let density = |made: &Made| made.number("/quality/interior_generating_density/value");
    assert!(density(&bare) > 0.595);
    assert!(density(&settled) > density(&bare) + 0.025);
    let sigmas = |made: &Made| made.number("/quality/interior_fabric/largest_deviation_in_sigma");
    assert!(sigmas(&bare) > 4.0 && sigmas(&settled) < 3.0);
}
