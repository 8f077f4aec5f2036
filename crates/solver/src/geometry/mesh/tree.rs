//! A tree of boxes over triangles: halved across the longest side of the box of their middles,
//! until few are left.

use super::super::Bounds;
use serde::Serialize;

/// Triangles that are not divided further.
const FEW: usize = 4;

/// A box and what is in it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Node {
    bounds: Bounds,
    /// A leaf: the first of its triangles. Otherwise the second child; the first child is the next
    /// node.
    at: u32,
    /// Triangles of a leaf; 0 for others.
    count: u32,
}

/// Boxes over triangles in the order of the tree.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(super) struct Tree {
    nodes: Vec<Node>,
}

impl Tree {
    /// The tree over triangles with these boxes, and the order in which they are to stand. Equal
    /// input gives equal order.
    pub(super) fn new(boxes: &[Bounds]) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut tree = Self::default();
        if !order.is_empty() {
            tree.halve(boxes, &mut order, 0);
        }
        (tree, order)
    }

    fn halve(&mut self, boxes: &[Bounds], order: &mut [u32], first: u32) {
        let bounds = order
            .iter()
            .fold(Bounds::EMPTY, |b, t| b.with(&boxes[*t as usize]));
        let this = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            at: first,
            count: order.len() as u32,
        });
        if order.len() <= FEW {
            return;
        }
        let twice_middle = |t: &u32, k: usize| {
            let b = &boxes[*t as usize];
            b.low[k] + b.high[k]
        };
        let middles = Bounds::of(order.iter().map(|t| [0, 1, 2].map(|k| twice_middle(t, k))));
        let extent = [0, 1, 2].map(|k| middles.high[k] - middles.low[k]);
        let longest = (1..3).fold(0, |best, k| if extent[k] > extent[best] { k } else { best });
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| {
            twice_middle(a, longest)
                .total_cmp(&twice_middle(b, longest))
                .then(a.cmp(b))
        });
        let (left, right) = order.split_at_mut(half);
        self.halve(boxes, left, first);
        self.nodes[this].at = self.nodes.len() as u32;
        self.nodes[this].count = 0;
        self.halve(boxes, right, first + half as u32);
    }

    /// Calls `visit` with each triangle of the leaves that lie within `reach` of a point along each
    /// axis, in order.
    pub(super) fn visit_near(&self, point: &[f64; 3], reach: f64, visit: &mut impl FnMut(u32)) {
        if !self.nodes.is_empty() {
            self.visit_node(0, point, reach, visit);
        }
    }

    fn visit_node(&self, at: u32, point: &[f64; 3], reach: f64, visit: &mut impl FnMut(u32)) {
        let node = &self.nodes[at as usize];
        if !node.bounds.is_near(point, reach) {
            return;
        }
        if node.count > 0 {
            (node.at..node.at + node.count).for_each(visit);
        } else {
            self.visit_node(at + 1, point, reach, visit);
            self.visit_node(node.at, point, reach, visit);
        }
    }

    /// Calls `visit` with each triangle of the leaves that a ray from a point along z may meet, in
    /// order.
    pub(super) fn visit_above(&self, point: &[f64; 3], visit: &mut impl FnMut(u32)) {
        if !self.nodes.is_empty() {
            self.visit_node_above(0, point, visit);
        }
    }

    fn visit_node_above(&self, at: u32, point: &[f64; 3], visit: &mut impl FnMut(u32)) {
        let node = &self.nodes[at as usize];
        let Bounds { low, high } = &node.bounds;
        let is_below = (0..2).all(|k| point[k] >= low[k] && point[k] <= high[k]);
        if !is_below || point[2] > high[2] {
            return;
        }
        if node.count > 0 {
            (node.at..node.at + node.count).for_each(visit);
        } else {
            self.visit_node_above(at + 1, point, visit);
            self.visit_node_above(node.at, point, visit);
        }
    }

    /// The box around all.
    pub(super) fn bounds(&self) -> Bounds {
        self.nodes.first().map_or(Bounds::EMPTY, |node| node.bounds)
    }
}
