//! Placed shapes: a tree over their boxes, traced ray by ray after the triangles.
//!
//! As with triangles, a shape counts as hit only if the ray meets the shape's own box, and no nearer than there: so the
//! tree never culls a hit, whatever the rounding, and results do not depend on it (see the test of rays against boxes).

use ambray_core::shape::Shape;
use ambray_core::trace::{Hit, Ray};
use ambray_scene::{Motion, Scene};

use crate::AlphaTest;
use crate::bvh::build;
use crate::bvh::layout::{Bounds, Child, Tlas};
use crate::kernel;
use crate::levels::place;

/// Children of a node: the boxes are tested one by one, so few of them at a time.
const WIDTH: usize = 8;

/// The placed shapes of a scene.
#[derive(Debug)]
pub(crate) struct Shapes {
    shapes: Vec<Shape>,
    tree: Tlas<WIDTH>,
    stack: usize,
    /// Whether any of them moves.
    moving: bool,
}

impl Shapes {
    /// `None` if there are no shapes. Instances whose placement cannot be inverted are dropped, those that move only until
    /// the next pose.
    pub(crate) fn build(scene: &Scene) -> Option<Self> {
        if scene.shape_instances.is_empty() {
            return None;
        }
        let moving = scene.rig.is_some() && scene.shape_instances.iter().any(|i| i.motion != Motion::Static);
        let mut shapes = Self { shapes: scene.shapes.clone(), tree: Tlas::default(), stack: 0, moving };
        shapes.place(scene);
        Some(shapes)
    }

    /// Moves the shapes to where `scene` has them.
    pub(crate) fn update(&mut self, scene: &Scene) {
        if self.moving {
            self.place(scene);
        }
    }

    fn place(&mut self, scene: &Scene) {
        let first = u32::try_from(scene.instances.len()).expect("instances have 32-bit numbers");
        let (mut placed, mut boxes) = (Vec::new(), Vec::new());
        for (index, instance) in (first..).zip(&scene.shape_instances) {
            let (lo, hi) = self.shapes[instance.shape as usize].bounds();
            let placement = instance.world_from_object;
            if let Some((one, world)) = place(instance.shape, index, placement, Bounds { lo, hi }) {
                placed.push(one);
                boxes.push(world);
            }
        }
        self.tree = build::tlas(placed, &boxes);
        self.stack = kernel::stack_for(self.tree.depth, WIDTH);
    }

    /// Instances that can be hit, nodes of the tree, its depth and its memory in bytes.
    pub(crate) fn size(&self) -> (usize, usize, usize, usize) {
        let (nodes, instances) = (&self.tree.nodes[..], &self.tree.instances[..]);
        let samples = |shape: &Shape| match shape {
            Shape::Field(field) => size_of_val(field.distances()),
            _ => 0,
        };
        let bytes = size_of_val(nodes)
            + size_of_val(instances)
            + size_of_val(&self.shapes[..])
            + self.shapes.iter().map(samples).sum::<usize>();
        (instances.len(), nodes.len(), self.tree.depth, bytes)
    }

    /// Replaces the `hits` of `rays` that a shape is closer than. Shapes lose ties: their instances come last.
    pub(crate) fn closest_hits(&self, alpha: &dyn AlphaTest, rays: &[Ray], hits: &mut [Hit]) {
        let mut stack = Vec::with_capacity(self.stack);
        for (ray, hit) in rays.iter().zip(hits) {
            let limit = if hit.is_hit() { hit.t } else { ray.t_max };
            let found = self.trace::<false>(alpha, ray, limit, &mut stack);
            if found.is_hit() && (!hit.is_hit() || found.t < hit.t) {
                *hit = found;
            }
        }
    }

    /// Marks the rays that a shape blocks.
    pub(crate) fn any_hits(&self, alpha: &dyn AlphaTest, rays: &[Ray], blocked: &mut [bool]) {
        let mut stack = Vec::with_capacity(self.stack);
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = *blocked || self.trace::<true>(alpha, ray, ray.t_max, &mut stack).is_hit();
        }
    }

    /// The closest hit at t in (0, `limit`], or if `ANY` some hit.
    fn trace<const ANY: bool>(
        &self,
        alpha: &dyn AlphaTest,
        ray: &Ray,
        limit: f32,
        stack: &mut Vec<(Child, f32)>,
    ) -> Hit {
        let mut best = Hit { t: limit, ..Hit::MISS };
        let Some(slabs) = kernel::ray::Prepared::new(ray.origin, ray.direction) else { return Hit::MISS };
        if limit.is_nan() || limit <= 0.0 || self.tree.nodes.is_empty() {
            return Hit::MISS;
        }
        stack.clear();
        stack.push((Child::ROOT, 0.0));
        while let Some((child, near)) = stack.pop() {
            if near > best.t {
                continue;
            }
            if child.is_leaf() {
                let placed = &self.tree.instances[child.index()];
                let origin = placed.object_from_world.transform_point3(ray.origin);
                // Not of unit length, so that t means the same in both spaces.
                let direction = placed.object_from_world.transform_vector3(ray.direction);
                if !origin.is_finite() || !direction.is_finite() || direction == glam::Vec3::ZERO {
                    continue;
                }
                let shape = &self.shapes[placed.blas as usize];
                // Not up to the best hit so far: a field's surface is found in cells, and where the last one is cut off
                // shows in the last bits.
                let Some(t) = shape.intersect(origin, direction, ray.t_max) else { continue };
                let t = t.max(near);
                let closer = t < best.t || (t == best.t && placed.instance < best.instance);
                if closer && alpha.accepts(placed.instance, 0, 0.0, 0.0, ray.seed) {
                    best = Hit { t, u: 0.0, v: 0.0, instance: placed.instance, triangle: 0 };
                    if ANY {
                        return best;
                    }
                }
                continue;
            }
            let node = &self.tree.nodes[child.index()];
            for lane in 0..WIDTH {
                let planes = std::array::from_fn(|plane| node.planes[plane][lane]);
                if let Some(near) = kernel::slab::one(&planes, &slabs).filter(|&near| near <= best.t) {
                    stack.push((node.children[lane], near));
                }
            }
        }
        if best.is_hit() { best } else { Hit::MISS }
    }
}
