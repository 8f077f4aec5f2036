//! A tree of boxes: which boxes lie in some place, which overlap each other.

use super::vector::Point;

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) min: Point,
    pub(super) max: Point,
}

impl Bounds {
    const EMPTY: Self = Self {
        min: [f64::INFINITY; 3],
        max: [f64::NEG_INFINITY; 3],
    };

    /// The box of some points.
    pub(super) fn of(points: impl IntoIterator<Item = Point>) -> Self {
        let (min, max) = super::vector::bounds(points);
        Self { min, max }
    }

    /// The box larger by `margin` on every side.
    pub(super) fn grown(self, margin: f64) -> Self {
        Self {
            min: self.min.map(|x| x - margin),
            max: self.max.map(|x| x + margin),
        }
    }

    /// The smallest box around both.
    pub(super) fn with(self, other: Self) -> Self {
        let mut sum = self;
        for k in 0..3 {
            sum.min[k] = sum.min[k].min(other.min[k]);
            sum.max[k] = sum.max[k].max(other.max[k]);
        }
        sum
    }

    /// The box that both have in common; it may be empty.
    pub(super) fn common(self, other: Self) -> Self {
        let mut common = self;
        for k in 0..3 {
            common.min[k] = common.min[k].max(other.min[k]);
            common.max[k] = common.max[k].min(other.max[k]);
        }
        common
    }

    /// Whether the boxes have a point in common.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }

    /// Whether a segment comes within `margin` of the box along each axis.
    pub(super) fn on_segment(&self, [start, end]: [Point; 2], margin: f64) -> bool {
        let (mut near, mut far) = (0.0_f64, 1.0_f64);
        for k in 0..3 {
            let (min, max) = (
                self.min[k] - margin - start[k],
                self.max[k] + margin - start[k],
            );
            let along = end[k] - start[k];
            if along != 0.0 {
                near = near.max((min / along).min(max / along));
                far = far.min((min / along).max(max / along));
            } else if min > 0.0 || max < 0.0 {
                return false;
            }
        }
        near <= far
    }

    /// Whether the ray from `origin` meets the box; `inverse` is 1/direction, no component of it
    /// infinite.
    pub(super) fn on_ray(&self, origin: Point, inverse: Point) -> bool {
        let (mut near, mut far) = (0.0_f64, f64::INFINITY);
        for k in 0..3 {
            let t1 = (self.min[k] - origin[k]) * inverse[k];
            let t2 = (self.max[k] - origin[k]) * inverse[k];
            near = near.max(t1.min(t2));
            far = far.min(t1.max(t2));
        }
        // A margin for rounding: a box that is flat along an axis must not be missed.
        near <= far + 1e-12 * (1.0 + far.abs()) && self.min[0] <= self.max[0]
    }
}

/// Boxes of a leaf.
const LEAF: usize = 4;

/// A complete binary tree over boxes in the order of their place on a space-filling curve (Morton
/// order).
pub(super) struct Tree {
    /// Number of each box, in the order of the curve.
    order: Vec<u32>,
    /// The boxes, in that order.
    boxes: Vec<Bounds>,
    /// Node 1 is the root, nodes 2i and 2i + 1 are the children of i, the last half are the leaves.
    nodes: Vec<Bounds>,
}

impl Tree {
    /// The tree over `boxes`; none of them empty.
    pub(super) fn new(boxes: &[Bounds]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        sort_along_curve(&mut order, boxes);
        let boxes: Vec<Bounds> = order.iter().map(|i| boxes[*i as usize]).collect();
        let leaves = boxes.len().div_ceil(LEAF).max(1).next_power_of_two();
        let mut nodes = vec![Bounds::EMPTY; 2 * leaves];
        for (leaf, content) in boxes.chunks(LEAF).enumerate() {
            nodes[leaves + leaf] = content.iter().fold(Bounds::EMPTY, |sum, b| sum.with(*b));
        }
        for node in (1..leaves).rev() {
            nodes[node] = nodes[2 * node].with(nodes[2 * node + 1]);
        }
        Self {
            order,
            boxes,
            nodes,
        }
    }

    /// The boxes of leaf node `node`, as places in the order of the curve.
    fn content(&self, node: usize) -> std::ops::Range<usize> {
        let begin = (node - self.nodes.len() / 2) * LEAF;
        begin.min(self.boxes.len())..(begin + LEAF).min(self.boxes.len())
    }

    /// Calls `found` with the number of every box for which `meets` is true. `meets` must be true
    /// of a box around such a box.
    pub(super) fn visit(&self, meets: impl Fn(&Bounds) -> bool, mut found: impl FnMut(u32)) {
        let mut stack = [0_usize; 64];
        let mut height = 1;
        stack[0] = 1;
        while height > 0 {
            height -= 1;
            let node = stack[height];
            if !meets(&self.nodes[node]) {
                continue;
            }
            if node < self.nodes.len() / 2 {
                stack[height] = 2 * node + 1;
                stack[height + 1] = 2 * node;
                height += 2;
            } else {
                self.content(node)
                    .filter(|i| meets(&self.boxes[*i]))
                    .for_each(|i| found(self.order[i]));
            }
        }
    }

    /// Calls `found` with each pair of boxes that are no farther apart than `gap` along any axis,
    /// as long as it returns true.
    pub(super) fn near_pairs(&self, gap: f64, mut found: impl FnMut(u32, u32) -> bool) {
        let mut stack = vec![(1_usize, 1_usize)];
        while let Some((a, b)) = stack.pop() {
            if !self.nodes[a].grown(gap).overlaps(&self.nodes[b]) {
                continue;
            }
            let inner = a < self.nodes.len() / 2;
            match (inner, a == b) {
                (true, true) => {
                    stack.extend([(2 * a, 2 * a), (2 * a + 1, 2 * a + 1), (2 * a, 2 * a + 1)])
                }
                (true, false) => stack.extend([
                    (2 * a, 2 * b),
                    (2 * a, 2 * b + 1),
                    (2 * a + 1, 2 * b),
                    (2 * a + 1, 2 * b + 1),
                ]),
                (false, same) => {
                    for i in self.content(a) {
                        let near = self.boxes[i].grown(gap);
                        let others = if same {
                            i + 1..self.content(a).end
                        } else {
                            self.content(b)
                        };
                        for j in others.filter(|j| near.overlaps(&self.boxes[*j])) {
                            if !found(self.order[i], self.order[j]) {
                                return;
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Sorts box numbers by the place of the boxes' middles on the Morton curve through them; middles
/// that share a cell of it, by a finer curve through these alone.
fn sort_along_curve(order: &mut [u32], boxes: &[Bounds]) {
    let middle = |i: u32| {
        let b = &boxes[i as usize];
        [0, 1, 2].map(|k| 0.5 * (b.min[k] + b.max[k]))
    };
    let (min, max) = super::vector::bounds(order.iter().map(|i| middle(*i)));
    if order.len() <= LEAF || min == max {
        return;
    }
    let mut keys: Vec<(u64, u32)> = order
        .iter()
        .map(|i| (place_on_curve(middle(*i), min, max), *i))
        .collect();
    keys.sort_unstable();
    order.iter_mut().zip(&keys).for_each(|(i, key)| *i = key.1);
    let mut begin = 0;
    for cell in keys.chunk_by(|a, b| a.0 == b.0) {
        if cell.len() < keys.len() {
            sort_along_curve(&mut order[begin..begin + cell.len()], boxes);
        }
        begin += cell.len();
    }
}

/// The place of a point on the Morton curve through the cube over the box from `min` to `max`.
fn place_on_curve(point: Point, min: Point, max: Point) -> u64 {
    const STEPS: f64 = (1 << 21) as f64;
    let extent = (0..3)
        .map(|k| max[k] - min[k])
        .fold(f64::MIN_POSITIVE, f64::max);
    let step = |k: usize| ((point[k] - min[k]) / extent * STEPS).clamp(0.0, STEPS - 1.0);
    (0..3).map(|k| spread(step(k) as u64) << k).sum()
}

/// The lowest 21 bits, two zeros put between each of them.
fn spread(mut bits: u64) -> u64 {
    bits &= 0x1f_ffff;
    bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
    bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
    bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes in no special order: a walk with three incommensurable steps.
    fn some_boxes(count: usize) -> Vec<Bounds> {
        (0..count)
            .map(|i| {
                let corner =
                    [0.618_034, 0.414_214, 0.732_051].map(|step| (i as f64 * step).fract());
                Bounds::of([corner, corner.map(|x| x + 0.02 + 0.1 * (x * 7.0).fract())])
            })
            .collect()
    }

    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        for count in [0, 1, 3, 4, 5, 100, 257] {
            let boxes = some_boxes(count);
            let tree = Tree::new(&boxes);
            let mut pairs = Vec::new();
            for gap in [0.0, 0.01] {
                pairs.clear();
                tree.near_pairs(gap, |a, b| {
                    pairs.push((a.min(b) as usize, a.max(b) as usize));
                    true
                });
                pairs.sort_unstable();
                let mut expected = Vec::new();
                for i in 0..count {
                    expected.extend(
                        (i + 1..count)
                            .filter(|j| boxes[i].grown(gap).overlaps(&boxes[*j]))
                            .map(|j| (i, j)),
                    );
                }
                assert_eq!(pairs, expected);
            }
            let place = Bounds {
                min: [0.3; 3],
                max: [0.5; 3],
            };
            let mut found = Vec::new();
            tree.visit(|b| b.overlaps(&place), |i| found.push(i as usize));
            found.sort_unstable();
            assert_eq!(
                found,
                (0..count)
                    .filter(|i| boxes[*i].overlaps(&place))
                    .collect::<Vec<_>>()
            );
        }
    }
}
