//! First batch: N rays from each point over the hemisphere.

use crate::{
    basis::Basis,
    sampling::{SampleDirection, pcg},
    trace::{Hit, Motion, Ray, World},
};

use super::{
    GatherParams, Gathered, ShadedPoint,
    radiance::RadianceScratch,
    samples::{Run, Samples, group, group_mut, in_groups},
};

use glam::Vec3;

/// Whether a hit on the instance `occluder` may move against a point on the instance `receiver`.
fn may_change(world: &impl World, receiver: u32, occluder: u32) -> bool {
    let motion = world.motion(occluder);
    if receiver == occluder {
        return motion == Motion::Deforming;
    }
    motion != Motion::Static || world.motion(receiver) != Motion::Static
}

/// The rays of a batch of points and what became of them.
#[derive(Debug, Default)]
pub(super) struct FirstBatch {
    pub(super) samples: Samples,
    pub(super) rays: Vec<Ray>,
    /// At least as many as rays.
    hits: Vec<Hit>,
    /// Sample that each ray belongs to.
    pub(super) slots: Vec<u32>,
    /// Point that each ray starts from.
    owners: Vec<u32>,
    albedos: Vec<Vec3>,
    starts: Starts,
}

/// Where the rays of the points of a run start, as structure of arrays.
#[derive(Debug, Default)]
struct Starts {
    /// Bases: tangent, bitangent, normal.
    basis: [[Vec<f32>; 3]; 3],
    /// Geometric normals.
    horizon: [Vec<f32>; 3],
    origins: Vec<Vec3>,
    hashes: Vec<u32>,
    /// Directions of a sample, where each point has its own.
    local: [Vec<f32>; 3],
}

impl FirstBatch {
    /// The hits of the rays.
    pub(super) fn hits(&self) -> &[Hit] {
        &self.hits[..self.rays.len()]
    }

    #[inline(always)]
    pub(super) fn trace(
        &mut self,
        world: &impl World,
        params: &GatherParams<'_>,
        points: &[ShadedPoint],
        radiance: &mut RadianceScratch,
        out: &mut [Gathered],
    ) {
        self.make_rays(params, points);
        // Tracers write every answer, so that old ones need not be cleared.
        if self.hits.len() < self.rays.len() {
            self.hits.resize(self.rays.len(), Hit::MISS);
        }
        let hits = &mut self.hits[..self.rays.len()];
        world.closest_hits(&self.rays, hits);
        for (hit, &slot) in hits.iter().zip(&self.slots) {
            self.samples.distance[slot as usize] = hit.t;
        }
        if params.temporal {
            self.find_changing(world, points);
        }
        if params.needs_radiance() {
            self.find_radiance(world, params, radiance, out);
        }
    }

    /// Which of the hits may move against their points.
    fn find_changing(&mut self, world: &impl World, points: &[ShadedPoint]) {
        self.samples.changing.fill(0.0);
        let hits = self.hits.iter().zip(&self.slots).zip(&self.owners);
        for ((hit, &slot), &owner) in hits.filter(|((hit, _), _)| hit.is_hit()) {
            let changes = may_change(world, points[owner as usize].instance, hit.instance);
            self.samples.changing[slot as usize] = f32::from(u8::from(changes));
        }
    }

    /// Radiance L_r of all hits.
    #[inline(always)]
    fn find_radiance(
        &mut self,
        world: &impl World,
        params: &GatherParams<'_>,
        scratch: &mut RadianceScratch,
        out: &mut [Gathered],
    ) {
        let hits = &self.hits[..self.rays.len()];
        let [red, green, blue] = &mut self.samples.radiance;
        let mut write = |slot: u32, radiance: Vec3| {
            let slot = slot as usize;
            (red[slot], green[slot], blue[slot]) = radiance.into();
        };
        if let Some(factor) = params.albedo_factor() {
            self.albedos.resize(hits.len(), Vec3::ZERO);
            world.albedos_at(&self.rays, hits, params.cone_width(), &mut self.albedos);
            for (&albedo, &slot) in self.albedos.iter().zip(&self.slots) {
                write(slot, albedo * factor);
            }
            return;
        }
        scratch.clear();
        for (i, (ray, hit)) in self.rays.iter().zip(hits).enumerate() {
            if hit.is_hit() {
                scratch.push(world, ray, hit, hit.t * params.cone_width(), i as u32);
            } else {
                write(self.slots[i], Vec3::ZERO);
            }
        }
        scratch.evaluate(world, params);
        for (ray, radiance, shadow_rays) in scratch.results(params) {
            write(self.slots[ray as usize], radiance);
            out[self.owners[ray as usize] as usize].shadow_rays += shadow_rays;
        }
    }

    /// Samples of all points, and rays for those above the geometric horizon.
    #[inline(always)]
    fn make_rays(&mut self, params: &GatherParams<'_>, points: &[ShadedPoint]) {
        self.samples.begin(params, points);
        // Room for all, so that the loop need not ask.
        let most = self.samples.distance.len();
        self.rays.resize(most, NO_RAY);
        self.slots.resize(most, 0);
        self.owners.resize(most, 0);
        let mut count = 0;
        for i in 0..self.samples.runs.len() {
            let run = self.samples.runs[i];
            self.starts.begin(params, &points[run.range()]);
            for j in 0..params.samples.spp() as usize {
                self.make_sample(params, &points[run.range()], &run, j, &mut count);
            }
        }
        self.rays.truncate(count);
        self.slots.truncate(count);
        self.owners.truncate(count);
    }

    /// Sample `j` of all points of a `run`, after the `count` rays that are there.
    #[inline(always)]
    fn make_sample(
        &mut self,
        params: &GatherParams<'_>,
        points: &[ShadedPoint],
        run: &Run,
        j: usize,
        count: &mut usize,
    ) {
        let (samples, starts) = (&mut self.samples, &mut self.starts);
        let slot = run.slot(0, j);
        match params.samples.shared(points[0].key.class, j as u32) {
            Some(shared) => {
                in_groups!(run.points, make_group(samples, starts, slot, Local::Shared(shared.local)));
                if let Some(azimuth) = samples.azimuth.get_mut(slot..slot + run.points) {
                    azimuth.fill(shared.azimuth);
                }
            }
            None => {
                for (i, point) in points.iter().enumerate() {
                    let SampleDirection { local, azimuth } = params.samples.direction(point.key, j as u32);
                    (0..3).for_each(|axis| starts.local[axis][i] = local[axis]);
                    if let Some(place) = samples.azimuth.get_mut(slot + i) {
                        *place = azimuth;
                    }
                }
                in_groups!(run.points, make_group(samples, starts, slot, Local::Own));
            }
        }
        let sample = Rays { salt: pcg(j as u32), t_max: params.openness.reach(), first: run.first, slot };
        in_groups!(run.points, push_group(self, &sample, count));
    }
}

/// Takes the places of rays that are not there yet.
const NO_RAY: Ray = Ray { origin: Vec3::ZERO, t_max: 0.0, direction: Vec3::ZERO, seed: 0 };

/// What the rays of a sample share.
struct Rays {
    /// Tells their seeds from those of other samples.
    salt: u32,
    t_max: f32,
    /// Their first point, and the slot of its sample.
    first: usize,
    slot: usize,
}

/// Adds the rays of the `L` points from `at` on that are above their horizon.
#[inline(always)]
fn push_group<const L: usize>(at: usize, batch: &mut FirstBatch, sample: &Rays, count: &mut usize) {
    let FirstBatch { samples, rays, slots, owners, starts, .. } = batch;
    let slot = sample.slot + at;
    let [x, y, z] = samples.direction.each_ref().map(|plane| group::<L>(plane, slot));
    let origins: &[Vec3; L] = starts.origins[at..at + L].try_into().expect("L origins");
    let hashes: &[u32; L] = starts.hashes[at..at + L].try_into().expect("L hashes");
    let above = group::<L>(&samples.distance, slot);
    let mut seeds = [0; L];
    for lane in 0..L {
        seeds[lane] = pcg(hashes[lane] ^ sample.salt);
    }
    let ray = |lane: usize| Ray {
        origin: origins[lane],
        t_max: sample.t_max,
        direction: Vec3::new(x[lane], y[lane], z[lane]),
        seed: seeds[lane],
    };
    let places = *count..*count + L;
    let (rays, slots, owners) = (&mut rays[places.clone()], &mut slots[places.clone()], &mut owners[places]);
    let (slot, owner) = (slot as u32, (sample.first + at) as u32);
    // Each is written, and stays where one above the horizon is next: no branch that depends on the ray.
    let mut next = 0;
    for (lane, &distance) in above.iter().enumerate() {
        rays[next] = ray(lane);
        slots[next] = slot + lane as u32;
        owners[next] = owner + lane as u32;
        next += usize::from(distance > 0.0);
    }
    *count += next;
}

/// Directions of a sample in the bases of the points.
#[derive(Clone, Copy)]
enum Local {
    /// The same one for all points.
    Shared(Vec3),
    /// Those in [`Starts::local`].
    Own,
}

/// Directions of the `L` points from `at` on, whose samples are at `slot` + `at`. Those below the geometric horizon are
/// blocked at once, without a ray (spec §5).
#[inline(always)]
fn make_group<const L: usize>(at: usize, samples: &mut Samples, starts: &Starts, slot: usize, local: Local) {
    // What is computed stays apart from what is read until all is: the memory of neither is known not to be the other's.
    let (mut height, mut direction) = ([0.0; L], [[0.0; L]; 3]);
    let own = starts.local.each_ref().map(|plane| group::<L>(plane, at));
    for axis in 0..3 {
        let [tangent, bitangent, normal] = starts.basis.each_ref().map(|of| group::<L>(&of[axis], at));
        let horizon = group::<L>(&starts.horizon[axis], at);
        for lane in 0..L {
            let [x, y, z] = match local {
                Local::Shared(local) => local.to_array(),
                Local::Own => [own[0][lane], own[1][lane], own[2][lane]],
            };
            direction[axis][lane] = tangent[lane] * x + bitangent[lane] * y + normal[lane] * z;
            height[lane] += direction[axis][lane] * horizon[lane];
        }
    }
    let distance = height.map(|height| if height > 0.0 { f32::INFINITY } else { 0.0 });
    *group_mut(&mut samples.distance, slot + at) = distance;
    for (axis, direction) in direction.into_iter().enumerate() {
        *group_mut(&mut samples.direction[axis], slot + at) = direction;
        *group_mut(&mut samples.radiance[axis], slot + at) = [0.0; L];
    }
}

impl Starts {
    /// Sets out from `points`.
    #[inline(always)]
    fn begin(&mut self, params: &GatherParams<'_>, points: &[ShadedPoint]) {
        let planes = self.basis.iter_mut().flatten().chain(&mut self.horizon).chain(&mut self.local);
        planes.for_each(|plane| plane.resize(points.len(), 0.0));
        self.hashes.resize(points.len(), 0);
        self.origins.resize(points.len(), Vec3::ZERO);
        for (i, point) in points.iter().enumerate() {
            self.hashes[i] = point.key.hash;
            self.origins[i] = params.offset.apply(point.position, point.geometric_normal, point.reach);
            let Basis { tangent, bitangent, normal } = Basis::from_normal(point.normal);
            for axis in 0..3 {
                self.basis[0][axis][i] = tangent[axis];
                self.basis[1][axis][i] = bitangent[axis];
                self.basis[2][axis][i] = normal[axis];
                self.horizon[axis][i] = point.geometric_normal[axis];
            }
        }
    }
}
