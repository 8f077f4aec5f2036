//! Seeded random numbers and gradient noise after Perlin (doi.org/10.1145/566654.566636), from
//! integers and plain arithmetic only.

/// The SplitMix64 generator.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        scramble(self.0)
    }

    /// Uniform between `from` and `to`.
    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A direction, all equally likely.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        loop {
            let v: [f64; 3] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            let square = super::mesh::dot(v, v);
            if (0.01..1.0).contains(&square) {
                return super::mesh::unit(v);
            }
        }
    }
}

fn scramble(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Smooth noise with features of size 1, about -1 to 1, zero on average and at points with whole
/// coordinates.
pub(crate) fn noise(seed: u64, point: [f64; 3]) -> f64 {
    let cell = point.map(f64::floor);
    let within: [f64; 3] = std::array::from_fn(|k| point[k] - cell[k]);
    let weight = within.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let mut sum = 0.0;
    for corner in 0..8_usize {
        let at: [f64; 3] = std::array::from_fn(|k| (corner >> k & 1) as f64);
        let mut hash = seed;
        let mut fraction = 1.0;
        for k in 0..3 {
            hash = scramble(
                hash ^ ((cell[k] + at[k]) as i64 as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15),
            );
            fraction *= if at[k] > 0.0 {
                weight[k]
            } else {
                1.0 - weight[k]
            };
        }
        sum += fraction * slope(hash, std::array::from_fn(|k| within[k] - at[k]));
    }
    sum
}

/// Scalar product of `offset` with one of the twelve directions to the middles of a cube's edges.
fn slope(hash: u64, offset: [f64; 3]) -> f64 {
    let axis = (hash >> 8) as usize % 3;
    let (u, v) = (offset[(axis + 1) % 3], offset[(axis + 2) % 3]);
    let u = if hash & 1 == 0 { u } else { -u };
    let v = if hash & 2 == 0 { v } else { -v };
    u + v
}

/// Sum of `octaves` layers of noise, each of half the size and `fade` times the height of the one
/// before.
pub(crate) fn layered(seed: u64, point: [f64; 3], octaves: u32, fade: f64) -> f64 {
    let mut sum = 0.0;
    let (mut scale, mut height) = (1.0, 1.0);
    for octave in 0..octaves {
        let shifted = point.map(|x| x * scale + 0.37 * f64::from(octave + 1));
        sum += height * noise(seed.wrapping_add(u64::from(octave)), shifted);
        scale *= 2.0;
        height *= fade;
    }
    sum
}
