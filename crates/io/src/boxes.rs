//! A tree of boxes: which boxes lie in some place, which overlap each other.

use crate::bounds::Bounds;
use serde::Serialize;

/// Boxes that are not divided further.
const FEW: usize = 4;

/// A box around others, or around what is in a leaf.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Node {
    bounds: Bounds,
    /// A leaf: the place of its first box. Otherwise the second child; the first child is the next
    /// node.
    at: u32,
    /// Boxes of a leaf; 0 for others.
    count: u32,
}

impl Node {
    /// The places of the boxes of a leaf; none for others.
    fn places(&self) -> std::ops::Range<usize> {
        self.at as usize..(self.at + self.count) as usize
    }
}

/// Boxes halved across the longest side of the box of their middles, until few are left.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tree {
    nodes: Vec<Node>,
    /// Number of the box at each place.
    #[serde(skip)]
    order: Vec<u32>,
    /// The box at each place.
    #[serde(skip)]
    boxes: Vec<Bounds>,
}

/// What the boxes are sorted by: twice the middle of one, and its number.
struct Key {
    twice_middle: [f64; 3],
    number: u32,
}

impl Tree {
    /// The tree over `boxes`; none of them empty. Equal input gives equal order.
    pub fn new(boxes: &[Bounds]) -> Self {
        let mut keys: Vec<Key> = (0..)
            .zip(boxes)
            .map(|(number, b)| Key {
                twice_middle: [0, 1, 2].map(|k| b.low[k] + b.high[k]),
                number,
            })
            .collect();
        let mut nodes = Vec::new();
        if !keys.is_empty() {
            halve(boxes, &mut keys, 0, &mut nodes);
        }
        let order: Vec<u32> = keys.iter().map(|key| key.number).collect();
        Self {
            nodes,
            boxes: order.iter().map(|i| boxes[*i as usize]).collect(),
            order,
        }
    }

    /// Number of the box at each place: the boxes of a leaf stand next to each other, and so do
    /// leaves that are near.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The box around all.
    pub fn bounds(&self) -> Bounds {
        self.nodes.first().map_or(Bounds::EMPTY, |node| node.bounds)
    }

    /// Calls `found` with the number of every box for which `meets` is true. `meets` must be true
    /// of a box around such a box.
    pub fn visit(&self, meets: impl Fn(&Bounds) -> bool, mut found: impl FnMut(u32)) {
        self.visit_leaves(&meets, |place| {
            if meets(&self.boxes[place as usize]) {
                found(self.order[place as usize]);
            }
        });
    }

    /// Calls `found` with the place in [`Self::order`] of every box in a leaf for which `meets` is
    /// true, rising.
    pub fn visit_leaves(&self, meets: impl Fn(&Bounds) -> bool, mut found: impl FnMut(u32)) {
        self.any_leaf(meets, |place| {
            found(place);
            false
        });
    }

    /// Whether `wanted` is true of the place of any box in a leaf for which `meets` is true. They
    /// are asked in rising order, up to the first.
    pub fn any_leaf(
        &self,
        meets: impl Fn(&Bounds) -> bool,
        mut wanted: impl FnMut(u32) -> bool,
    ) -> bool {
        self.any_below(0, &meets, &mut wanted)
    }

    fn any_below(
        &self,
        at: u32,
        meets: &impl Fn(&Bounds) -> bool,
        wanted: &mut impl FnMut(u32) -> bool,
    ) -> bool {
        let node = self.nodes.get(at as usize);
        let Some(node) = node.filter(|node| meets(&node.bounds)) else {
            return false;
        };
        if node.count > 0 {
            return (node.at..node.at + node.count).any(wanted);
        }
        self.any_below(at + 1, meets, wanted) || self.any_below(node.at, meets, wanted)
    }

    /// The smallest distance from a point to what is in the boxes, m; infinite without boxes.
    /// `distance_m` is called with places in [`Self::order`], those of near boxes first.
    pub fn nearest(&self, point: &[f64; 3], distance_m: impl Fn(u32) -> f64) -> f64 {
        let mut least_m = f64::INFINITY;
        let mut stack = vec![(0_u32, 0.0_f64)];
        while let Some((at, apart_m)) = stack.pop() {
            let Some(node) = self.nodes.get(at as usize).filter(|_| apart_m < least_m) else {
                continue;
            };
            if node.count > 0 {
                let all = (node.at..node.at + node.count).map(&distance_m);
                least_m = all.fold(least_m, f64::min);
                continue;
            }
            let children = [at + 1, node.at];
            let [first, second] =
                children.map(|child| (child, self.nodes[child as usize].bounds.distance(point)));
            if first.1 <= second.1 {
                stack.extend([second, first]);
            } else {
                stack.extend([first, second]);
            }
        }
        least_m
    }

    /// Calls `found` with each pair of boxes that are no farther apart than `gap` along any axis,
    /// as long as it returns true.
    pub fn near_pairs(&self, gap: f64, mut found: impl FnMut(u32, u32) -> bool) {
        if self.nodes.is_empty() {
            return;
        }
        let mut stack = vec![(0, 0)];
        while let Some((a, b)) = stack.pop() {
            let (node, other) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            if !node.bounds.grown(gap).overlaps(&other.bounds) {
                continue;
            }
            match (node.count > 0, other.count > 0) {
                (true, true) => {
                    for i in node.places() {
                        let near = self.boxes[i].grown(gap);
                        let begin = if a == b { i + 1 } else { other.at as usize };
                        for j in
                            (begin..other.places().end).filter(|j| near.overlaps(&self.boxes[*j]))
                        {
                            if !found(self.order[i], self.order[j]) {
                                return;
                            }
                        }
                    }
                }
                (true, false) => stack.extend([(a, b + 1), (a, other.at)]),
                (false, true) => stack.extend([(a + 1, b), (node.at, b)]),
                (false, false) if a == b => {
                    stack.extend([(a + 1, a + 1), (node.at, node.at), (a + 1, node.at)]);
                }
                (false, false) => stack.extend([
                    (a + 1, b + 1),
                    (a + 1, other.at),
                    (node.at, b + 1),
                    (node.at, other.at),
                ]),
            }
        }
    }
}

/// Adds the node over these boxes, the first of which is to stand at place `first`, and the nodes
/// below it; sorts the keys as the tree wants them.
fn halve(boxes: &[Bounds], keys: &mut [Key], first: usize, nodes: &mut Vec<Node>) {
    let this = nodes.len();
    nodes.push(Node {
        bounds: Bounds::EMPTY,
        at: first as u32,
        count: keys.len() as u32,
    });
    if keys.len() <= FEW {
        let all = keys.iter().map(|key| &boxes[key.number as usize]);
        nodes[this].bounds = all.fold(Bounds::EMPTY, |sum, b| sum.with(b));
        return;
    }
    let middles = Bounds::of(keys.iter().map(|key| key.twice_middle));
    let extent = [0, 1, 2].map(|k| middles.high[k] - middles.low[k]);
    let longest = (1..3).fold(0, |best, k| if extent[k] > extent[best] { k } else { best });
    let half = keys.len() / 2;
    keys.select_nth_unstable_by(half, |a, b| {
        a.twice_middle[longest]
            .total_cmp(&b.twice_middle[longest])
            .then(a.number.cmp(&b.number))
    });
    let (left, right) = keys.split_at_mut(half);
    halve(boxes, left, first, nodes);
    let second = nodes.len();
    halve(boxes, right, first + half, nodes);
    nodes[this] = Node {
        bounds: nodes[this + 1].bounds.with(&nodes[second].bounds),
        at: second as u32,
        count: 0,
    };
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

    const COUNTS: [usize; 7] = [0, 1, 3, 4, 5, 100, 257];

    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        for count in COUNTS {
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
                low: [0.3; 3],
                high: [0.5; 3],
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

    #[test]
    fn leaves_are_found_in_the_order_of_the_tree() {
        for count in COUNTS {
            let boxes = some_boxes(count);
            let tree = Tree::new(&boxes);
            let mut numbers = tree.order().to_vec();
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..count as u32));
            assert_eq!(
                tree.bounds(),
                boxes.iter().fold(Bounds::EMPTY, |sum, b| sum.with(b))
            );
            let is_near = |b: &Bounds| b.is_near(&[0.4; 3], 0.1);
            let mut places = Vec::new();
            tree.visit_leaves(is_near, |place| places.push(place));
            assert!(places.is_sorted_by(|a, b| a < b));
            for (place, number) in (0..).zip(tree.order()) {
                assert!(places.contains(&place) || !is_near(&boxes[*number as usize]));
            }
        }
    }

    #[test]
    fn boxes_in_a_row_stand_in_its_order() {
        let row: Vec<Bounds> = (0..100)
            .map(|i| Bounds::of([[0.0, f64::from(37 * i % 100), 0.0]]))
            .collect();
        let tree = Tree::new(&row);
        let order = tree.order().iter().map(|i| row[*i as usize].low[1]);
        assert!(order.eq((0..100).map(f64::from)));
    }
}
