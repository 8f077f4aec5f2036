//! A spatial order of particles in which near ones are near each other in memory, by bisection: cut
//! across the longest side of their box, then sort each half likewise.

/// Number of particles that are not divided further.
const FEW: usize = 8;

/// Indices of the positions in that order. Equal input gives equal order.
pub fn spatial_order(positions: &[[f64; 3]]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    halve(positions, &mut order);
    order
}

fn halve(positions: &[[f64; 3]], order: &mut [u32]) {
    if order.len() <= FEW {
        return;
    }
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &i in order.iter() {
        for k in 0..3 {
            low[k] = low[k].min(positions[i as usize][k]);
            high[k] = high[k].max(positions[i as usize][k]);
        }
    }
    let longest = (1..3).fold(0, |best, k| {
        if high[k] - low[k] > high[best] - low[best] {
            k
        } else {
            best
        }
    });
    let middle = order.len() / 2;
    let place = |i: &u32| positions[*i as usize][longest];
    order.select_nth_unstable_by(middle, |i, j| place(i).total_cmp(&place(j)).then(i.cmp(j)));
    let (left, right) = order.split_at_mut(middle);
    halve(positions, left);
    halve(positions, right);
}
