//! A tree of boxes over many primitives, so that a ray asks only those near its way.
//!
//! Crate `obvhs` pairs the primitives bottom up by the area of their boxes [Meister and Bittner 2018] and says which of
//! them share a leaf. Each two of its levels become one here, whose four boxes are met at once in single precision.
//!
//! No hit is lost. What a primitive's own test in double precision finds lies within 2^-22 D of its box, where D is how
//! far the ray's origin and the tree's farthest corner are from the tree's middle, together: a sphere's roots are those
//! of a sphere whose radius² differs by less than 2^-44 D², flat shapes are met within some hundred roundings of their
//! coordinates (but for triangles thinner than [`super::crowd`] admits). Single precision adds the roundings of a box
//! (2^-25 D), of the origin (2^-24 D), of the distance to a side (3 x 2^-24 D) and of the distance compared with
//! (2^-23 D). All of these are less than 2^-20 D, by which each ray takes every box to be larger. So the tree decides
//! which primitives are asked and never which one answers; and it needs no epsilon along the ray.

use super::Ray;
use glam::{DVec3, Vec4};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use std::ops::Range;

/// Primitives of one leaf, at most: fewer take more nodes than the cache holds, more take longer to ask.
const LEAF_SIZE: u32 = 8;
/// What meeting a box costs, in the time that it takes to ask a primitive.
const BOX_COST: f32 = 3.0;
/// Share of the nodes that are tried in better places [Meister and Bittner 2018b].
const REINSERTED: f32 = 0.05;
/// Nodes that wait on a ray's way, in all but strange trees.
const STACK: usize = 64;
/// Rays are at most so steep to a side of a box, for no product to be without a value: they miss by nothing that counts.
const STEEPEST: f32 = 1e30;

/// A tree over primitives that are numbered from 0, in the order of its leaves.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// The middle of all boxes, which is the origin of those in nodes.
    center: DVec3,
    /// A power of two that takes all coordinates into [-1, 1].
    scale: f64,
    /// By how much boxes are too small for a ray from the middle, in units of nodes.
    slack: f64,
    /// Nodes that can wait on a ray's way.
    waiting: usize,
}

/// Four boxes by their sides, and what is in them.
#[derive(Clone, Debug)]
struct Node {
    low: [Vec4; 3],
    high: [Vec4; 3],
    child: [Child; 4],
}

/// A node's number; or [`Child::LEAF`], a number of primitives and the first of them.
#[derive(Clone, Copy, Debug)]
struct Child(u32);

/// A ray as nodes see it.
struct Way {
    /// What coordinates of near sides, and of far sides, are measured from.
    near: [Vec4; 3],
    far: [Vec4; 3],
    inverse: [Vec4; 3],
    /// Whether it runs against an axis.
    against: [bool; 3],
}

impl Tree {
    /// A tree over these boxes, lowest and highest coordinates; and the numbers of its primitives among them.
    pub fn new(boxes: &[(DVec3, DVec3)]) -> (Tree, Vec<u32>) {
        let (low, high) =
            boxes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), b| (l.min(b.0), h.max(b.1)));
        let center = 0.5 * (low + high);
        let scale = libm::ldexp(1.0, -libm::frexp((0.5 * (high - low)).max_element()).1.clamp(-1000, 1000));
        let local = |p: DVec3| ((p - center) * scale).as_vec3a();
        let boxes: Vec<Aabb> = boxes.iter().map(|b| Aabb::new(local(b.0), local(b.1))).collect();
        let (nodes, order, depth) = widened(&paired(&boxes));
        // far from the world's origin its coordinates round more
        let largest = low.abs().max(high.abs()).max_element() * scale;
        let slack = 2.0 / (1 << 20) as f64 + largest / (1u64 << 46) as f64;
        (Tree { nodes, center, scale, slack, waiting: 3 * depth + 1 }, order)
    }

    /// Visits the leaves along a ray of unit direction, near ones first by and by, as far as `reach`; a visit answers
    /// how far is still of interest.
    #[inline]
    pub fn nearest(&self, ray: &Ray, reach: f64, mut visit: impl FnMut(Range<usize>) -> f64) {
        let way = self.way(ray.o, ray.d);
        let mut reach = (reach * self.scale) as f32;
        let (mut short, mut long) = ([(0f32, 0u32); STACK], Vec::new());
        let stack = self.stack(&mut short, &mut long);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (entry, id) = stack[height];
            if entry > reach {
                continue;
            }
            let node = &self.nodes[id as usize];
            let (base, (mut met, entries)) = (height, way.meet(node, reach));
            while met != 0 {
                let k = met.trailing_zeros() as usize;
                met &= met - 1;
                match node.child[k].inside() {
                    Ok(leaf) if entries[k] <= reach => reach = (visit(leaf) * self.scale) as f32,
                    Ok(_) => {}
                    Err(id) => {
                        // the nearest of this node's children on top
                        let mut place = height;
                        while place > base && stack[place - 1].0 < entries[k] {
                            stack[place] = stack[place - 1];
                            place -= 1;
                        }
                        stack[place] = (entries[k], id);
                        height += 1;
                    }
                }
            }
        }
    }

    /// Whether a visit to any leaf along the segment answers `true`.
    #[inline]
    pub fn any(&self, segment: &Ray, mut visit: impl FnMut(Range<usize>) -> bool) -> bool {
        let length = segment.d.length();
        let way = self.way(segment.o, segment.d / length);
        let reach = (length * self.scale) as f32;
        let (mut short, mut long) = ([(0f32, 0u32); STACK], Vec::new());
        let stack = self.stack(&mut short, &mut long);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let node = &self.nodes[stack[height].1 as usize];
            let (mut met, _) = way.meet(node, reach);
            while met != 0 {
                let k = met.trailing_zeros() as usize;
                met &= met - 1;
                match node.child[k].inside() {
                    Ok(leaf) => {
                        if visit(leaf) {
                            return true;
                        }
                    }
                    Err(id) => {
                        stack[height].1 = id;
                        height += 1;
                    }
                }
            }
        }
        false
    }

    /// Room for all nodes that can wait; the root waits first.
    #[inline]
    fn stack<'a>(
        &self,
        short: &'a mut [(f32, u32); STACK],
        long: &'a mut Vec<(f32, u32)>,
    ) -> &'a mut [(f32, u32)] {
        if self.waiting <= STACK {
            return short;
        }
        long.resize(self.waiting, (0.0, 0));
        long
    }

    #[inline]
    fn way(&self, o: DVec3, d: DVec3) -> Way {
        let o = (o - self.center) * self.scale;
        let slack = self.slack + o.abs().element_sum() / (1 << 20) as f64;
        let against = [0, 1, 2].map(|axis| d[axis].is_sign_negative());
        let side = |sign: f64| {
            [0, 1, 2]
                .map(|axis| Vec4::splat((o[axis] + sign * if against[axis] { -slack } else { slack }) as f32))
        };
        let inverse = [0, 1, 2].map(|axis| Vec4::splat((1.0 / d[axis]) as f32));
        let inverse = inverse.map(|v| v.clamp(Vec4::splat(-STEEPEST), Vec4::splat(STEEPEST)));
        Way { near: side(1.0), far: side(-1.0), inverse, against }
    }
}

impl Way {
    /// Which of a node's boxes are met within `reach`, one bit each, and where each is entered.
    #[inline]
    fn meet(&self, node: &Node, reach: f32) -> (u32, [f32; 4]) {
        let (mut entry, mut exit) = (Vec4::ZERO, Vec4::splat(reach));
        for axis in 0..3 {
            let (mut near, mut far) = (node.low[axis], node.high[axis]);
            if self.against[axis] {
                (near, far) = (far, near);
            }
            entry = entry.max((near - self.near[axis]) * self.inverse[axis]);
            exit = exit.min((far - self.far[axis]) * self.inverse[axis]);
        }
        (entry.cmple(exit).bitmask(), entry.to_array())
    }
}

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT: u32 = 27;
    /// A leaf that holds nothing.
    const NONE: Child = Child(Child::LEAF);

    fn leaf(first: usize, count: u32) -> Child {
        assert!(first < 1 << Child::COUNT, "more than 2^27 primitives");
        Child(Child::LEAF | count << Child::COUNT | first as u32)
    }

    /// The primitives of a leaf, or the number of a node.
    #[inline]
    fn inside(self) -> Result<Range<usize>, u32> {
        if self.0 & Child::LEAF == 0 {
            return Err(self.0);
        }
        let first = self.0 as usize & ((1 << Child::COUNT) - 1);
        let count = (self.0 & !Child::LEAF) >> Child::COUNT;
        Ok(first..first + count as usize)
    }
}

impl Node {
    const EMPTY: Node =
        Node { low: [Vec4::INFINITY; 3], high: [Vec4::NEG_INFINITY; 3], child: [Child::NONE; 4] };
}

/// The binary tree. Built by one thread, without any function that differs between platforms: the same everywhere.
fn paired(boxes: &[Aabb]) -> Bvh2 {
    let numbers = (0..boxes.len() as u32).collect();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    let mut tree = builder.build(PlocSearchDistance::Medium, boxes, numbers, SortPrecision::U64, 3);
    ReinsertionOptimizer::default().run(&mut tree, REINSERTED, None);
    collapse(&mut tree, LEAF_SIZE, BOX_COST);
    tree
}

/// Nodes of four children each, the numbers of the primitives in the order of the leaves, and how deep it is.
fn widened(tree: &Bvh2) -> (Vec<Node>, Vec<u32>, usize) {
    let (mut nodes, mut order, mut deepest) = (vec![Node::EMPTY], Vec::new(), 0);
    let mut todo = vec![(0, 0, 1)];
    while let Some((root, at, depth)) = todo.pop() {
        deepest = deepest.max(depth);
        for (k, id) in four_below(tree, root).into_iter().enumerate() {
            let child = &tree.nodes[id];
            for axis in 0..3 {
                nodes[at].low[axis][k] = child.aabb().min[axis];
                nodes[at].high[axis][k] = child.aabb().max[axis];
            }
            let first = child.first_index as usize;
            nodes[at].child[k] = if child.is_leaf() {
                let leaf = Child::leaf(order.len(), child.prim_count);
                order.extend_from_slice(&tree.primitive_indices[first..first + child.prim_count as usize]);
                leaf
            } else {
                nodes.push(Node::EMPTY);
                todo.push((id, nodes.len() - 1, depth + 1));
                Child((nodes.len() - 1) as u32)
            };
        }
    }
    (nodes, order, deepest)
}

/// Up to four nodes that together hold what is below `root`: the one with the largest box is opened, again and again.
fn four_below(tree: &Bvh2, root: usize) -> Vec<usize> {
    let mut nodes = vec![root];
    while nodes.len() < 4 {
        let inner = (0..nodes.len()).filter(|&k| !tree.nodes[nodes[k]].is_leaf());
        let area = |k: &usize| tree.nodes[nodes[*k]].aabb().half_area();
        let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
        let first = tree.nodes[nodes[largest]].first_index as usize;
        nodes[largest] = first;
        nodes.push(first + 1);
    }
    nodes
}
