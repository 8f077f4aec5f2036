//! Numbers from figures of Chung and Ooi 2011, as the program Kratos Multiphysics has them for its
//! own tests (`DEM_application/test_examples/basic_benchmarks/paper_data`, and
//! `DEMApplication/tests/DEM3D_chung_ooi_tests`): read off the figures, rounded here to what can be
//! read.

/// Spins after test 4, rad/s, over the angle to the normal, degrees: measured by Kharaz et al. 2001
/// on aluminium oxide.
pub(crate) const SPINS_MEASURED_RAD_S: [[f64; 2]; 10] = [
    [5.9, 135.0],
    [10.87, 261.0],
    [21.12, 574.0],
    [31.14, 612.0],
    [38.95, 595.0],
    [50.24, 450.0],
    [60.1, 376.0],
    [69.96, 243.0],
    [78.56, 142.0],
    [84.32, 71.0],
];

/// Angles of the surface to the normal after test 4, degrees, over the same.
pub(crate) const ANGLES_MEASURED_DEG: [[f64; 2]; 11] = [
    [2.1, 0.8],
    [3.94, 0.8],
    [9.72, -1.1],
    [20.31, -8.5],
    [30.16, -2.6],
    [39.12, 9.9],
    [49.51, 30.0],
    [59.9, 50.0],
    [70.46, 66.9],
    [78.86, 78.9],
    [84.78, 85.7],
];

/// Velocity along the wall after test 4 over that before it, aluminium oxide, by Chung and Ooi's
/// program.
pub(crate) const TANGENTIAL_RESTITUTION: [[f64; 2]; 13] = [
    [5.17, 0.948],
    [10.16, 0.687],
    [14.99, 0.624],
    [20.06, 0.616],
    [25.05, 0.634],
    [30.12, 0.684],
    [35.03, 0.737],
    [40.02, 0.781],
    [50.0, 0.845],
    [59.98, 0.893],
    [69.96, 0.932],
    [80.02, 0.966],
    [85.01, 0.983],
];

/// Slip after test 5 over friction and normal velocity, steel, over the same before it: by Chung
/// and Ooi's program.
pub(crate) const SLIP_STEEL: [[f64; 2]; 14] = [
    [0.33, -0.28],
    [0.67, -0.49],
    [1.01, -0.75],
    [1.34, -1.0],
    [1.66, -1.27],
    [2.0, -1.53],
    [2.35, -1.81],
    [2.99, -2.44],
    [3.34, -2.69],
    [4.01, -2.79],
    [5.0, -2.0],
    [6.0, -1.01],
    [9.99, 3.01],
    [12.96, 6.01],
];

/// The same by finite elements, as quoted there.
pub(crate) const SLIP_ELEMENTS: [[f64; 2]; 16] = [
    [0.27, -0.03],
    [0.59, -0.03],
    [0.88, -0.08],
    [1.19, -0.21],
    [1.55, -0.37],
    [1.92, -0.63],
    [2.31, -0.95],
    [2.79, -1.25],
    [3.32, -1.52],
    [3.97, -1.72],
    [4.76, -1.71],
    [5.76, -1.2],
    [7.12, 0.13],
    [9.12, 2.15],
    [12.36, 5.43],
    [12.96, 6.01],
];

/// Restitution of the surface in test 6 over 7/2 mu (1 + e) v_n/v_s, by Chung and Ooi's program.
pub(crate) const SURFACE_RESTITUTION: [[f64; 2]; 17] = [
    [0.187, -0.815],
    [0.358, -0.626],
    [0.551, -0.439],
    [0.765, -0.238],
    [0.979, -0.017],
    [1.214, 0.096],
    [1.492, 0.111],
    [1.77, 0.09],
    [2.091, 0.058],
    [2.519, 0.006],
    [2.989, -0.049],
    [3.631, -0.103],
    [4.508, -0.139],
    [5.77, -0.162],
    [7.845, -0.204],
    [11.91, -0.259],
    [23.99, -0.339],
];
