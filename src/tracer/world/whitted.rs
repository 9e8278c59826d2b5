//! Whitted ray tracing: direct light, mirrors and glass; T. Whitted, “An Improved Illumination Model for
//! Shaded Display”, CACM 23(6), 1980. Each sample follows its rays in depth-first order, reflection before
//! refraction; several samples do so side by side.

use smallvec::SmallVec;

use super::World;
use crate::glass::{Glass, GlassRays};
use crate::lanes::{Columns, Level, MAX_LANES};
use crate::light::{Cone, Light, LightDirections, ToPointLight};
use crate::material::{Brdf, Frame, Model};
use crate::ray::{FirstHit, Hit, Ray};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::sampler::SampleStream;
use crate::shape::{Primitive, Surfaces};
use crate::spheres::{PACKET_RAYS, Packet, PacketHits};

/// A ray to trace; its radiance is multiplied by its throughput.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch<T: Real> {
    pub(super) ray: Ray<T>,
    pub(super) throughput: T::Vec3,
    /// Number of segments from the camera to the end of the ray.
    pub(super) segments: u32,
}

/// State of one sample: its current ray and the radiance so far.
#[derive(Debug)]
pub(crate) struct PathState<T: Real> {
    pub(super) branch: Branch<T>,
    /// First hit of the current ray.
    pub(super) first: FirstHit<T>,
    /// Index of the sample's last deferred branch on the stack.
    top: Option<usize>,
    pub(super) stream: SampleStream,
    /// Radiance so far.
    pub(crate) sum: T::Vec3,
}

/// Append-only list of the deferred branches of all samples. Those of one sample form a stack: each has the
/// index of the previous one.
pub(super) type BranchStack<T> = Vec<(Branch<T>, Option<usize>)>;

impl<T: Real> PathState<T> {
    /// Creates the state for a camera ray with the given first hit.
    #[inline]
    pub(crate) fn new(ray: Ray<T>, first: FirstHit<T>, stream: SampleStream) -> Self {
        Self {
            branch: Branch {
                ray,
                throughput: T::Vec3::from_f64([1.0; 3]),
                segments: 1,
            },
            first,
            top: None,
            stream,
            sum: T::Vec3::ZERO,
        }
    }

    /// Adds the radiance that arrives along the current ray.
    #[inline]
    pub(super) fn add_light(&mut self, light: T::Vec3) {
        self.sum = self.sum + self.branch.throughput * light;
    }

    /// Defers a branch.
    pub(super) fn push_branch(&mut self, branch: Branch<T>, stack: &mut BranchStack<T>) {
        stack.push((branch, self.top));
        self.top = Some(stack.len() - 1);
    }

    /// Continues with the branch that was deferred last. Returns whether there was one.
    #[inline]
    pub(super) fn pop_branch(&mut self, stack: &BranchStack<T>) -> bool {
        let Some(last) = self.top else {
            return false;
        };
        (self.branch, self.top) = stack[last];
        true
    }
}

/// A surface point with a BRDF, to be lit by the lights.
struct LitPoint<'w, T: Real> {
    path: usize,
    hit: Hit<T>,
    brdf: &'w Brdf<T>,
    color: T::Vec3,
    /// Direction toward the origin of the ray.
    view: T::Vec3,
    light: T::Vec3,
}

/// A point on glass.
struct GlassPoint<'w, T: Real> {
    path: usize,
    hit: Hit<T>,
    glass: &'w Glass<T>,
    color: T::Vec3,
    /// Direction · normal.
    facing: T,
}

/// Points whose radiance is not yet known: at most [`PACKET_RAYS`].
struct PendingPoints<'w, T: Real> {
    lit: SmallVec<[LitPoint<'w, T>; PACKET_RAYS]>,
    glass_points: SmallVec<[GlassPoint<'w, T>; PACKET_RAYS]>,
    /// Samples that continue, by reflection or with a deferred branch.
    continuing: SmallVec<[usize; PACKET_RAYS]>,
}

impl<T: Real> Branch<T> {
    /// Creates the branch that continues from a point of the given color.
    fn follow(
        &self,
        hit: &Hit<T>,
        direction: T::Vec3,
        color: T::Vec3,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> Self {
        Self {
            ray: hit.spawn_ray(direction, policy),
            throughput: self.throughput * color,
            segments: self.segments + 1,
        }
    }
}

fn reflect<T: Real>(direction: T::Vec3, normal: T::Vec3, facing: T) -> T::Vec3 {
    direction - normal * (T::from_f64(2.0) * facing)
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Traces all rays of at most [`PACKET_RAYS`] samples.
    pub(super) fn whitted(&self, paths: &mut [PathState<T>], policy: &impl RayEpsilonPolicy<T>) {
        let mut active: SmallVec<[usize; PACKET_RAYS]> = (0..paths.len()).collect();
        let mut stack = BranchStack::new();
        let mut surfaces = [(); 2].map(|()| Columns::splat([T::zero(); 3]));
        let mut pending = PendingPoints {
            lit: SmallVec::new(),
            glass_points: SmallVec::new(),
            continuing: SmallVec::new(),
        };
        while !active.is_empty() {
            for indices in active.chunks(MAX_LANES) {
                let is_one = indices.len() == 1;
                if !is_one {
                    self.compute_surfaces(paths, indices, &mut surfaces);
                }
                for (lane, &at) in indices.iter().enumerate() {
                    let path = &mut paths[at];
                    let hit = if is_one {
                        self.hit(&path.branch.ray, path.first)
                    } else {
                        self.hit_in_lane(&surfaces, lane, path)
                    };
                    self.scatter(at, path, hit, &stack, &mut pending, policy);
                }
            }
            for points in pending.glass_points.chunks(MAX_LANES) {
                self.split_at_glass(paths, points, &mut stack, policy);
                pending.continuing.extend(points.iter().map(|point| point.path));
            }
            self.add_direct_light(paths, &mut pending.lit, policy);
            for point in &pending.lit {
                let path = &mut paths[point.path];
                path.add_light(point.light);
                if path.pop_branch(&stack) {
                    pending.continuing.push(point.path);
                }
            }
            pending.lit.clear();
            pending.glass_points.clear();
            active.clear();
            std::mem::swap(&mut active, &mut pending.continuing);
            self.find_first_hits(paths, &active, policy);
        }
    }

    /// Handles the end of a ray: adds its radiance, or records a point for later.
    fn scatter<'w>(
        &'w self,
        at: usize,
        path: &mut PathState<T>,
        hit: Option<Hit<T>>,
        stack: &BranchStack<T>,
        pending: &mut PendingPoints<'w, T>,
        policy: &impl RayEpsilonPolicy<T>,
    ) {
        let Branch { ray, segments, .. } = path.branch;
        let light = if let Some(hit) = hit {
            let material = &self.materials[hit.surface];
            let color = material.color(|| [hit.point, hit.normal]);
            let facing = ray.direction.dot(hit.normal);
            match &material.model {
                Model::Facing => color * facing.abs(),
                Model::Emitter => color,
                Model::Reflective(brdf) => {
                    pending.lit.push(LitPoint {
                        path: at,
                        hit,
                        brdf,
                        color,
                        view: -ray.direction,
                        light: color * self.ambient,
                    });
                    return;
                }
                Model::Mirror | Model::Glass(_) if segments == self.max_depth => T::Vec3::ZERO,
                Model::Mirror => {
                    let direction = reflect(ray.direction, hit.normal, facing);
                    path.branch = path.branch.follow(&hit, direction, color, policy);
                    pending.continuing.push(at);
                    return;
                }
                Model::Glass(glass) => {
                    pending.glass_points.push(GlassPoint {
                        path: at,
                        hit,
                        glass,
                        color,
                        facing,
                    });
                    return;
                }
            }
        } else {
            self.background.color(ray.direction)
        };
        path.add_light(light);
        if path.pop_branch(stack) {
            pending.continuing.push(at);
        }
    }

    /// Splits rays at up to [`MAX_LANES`] glass points: the reflected ray is next, the refracted ray is
    /// deferred.
    fn split_at_glass(
        &self,
        paths: &mut [PathState<T>],
        points: &[GlassPoint<T>],
        stack: &mut BranchStack<T>,
        policy: &impl RayEpsilonPolicy<T>,
    ) {
        let mut glass_rays = GlassRays::none();
        for point in points {
            let direction = paths[point.path].branch.ray.direction;
            glass_rays.push(point.glass, direction, point.hit.normal, point.facing);
        }
        let refraction = T::run(self.level_for(points.len()), &glass_rays);
        for (at, point) in points.iter().enumerate() {
            let path = &mut paths[point.path];
            let (branch, reflectance) = (path.branch, refraction.reflectances[at]);
            let color = |weight: T| point.color * weight;
            if let Some(refracted) = refraction.refracted(at) {
                let branch = branch.follow(&point.hit, refracted, color(T::one() - reflectance), policy);
                path.push_branch(branch, stack);
            }
            let mirrored = reflect(branch.ray.direction, point.hit.normal, point.facing);
            path.branch = branch.follow(&point.hit, mirrored, color(reflectance), policy);
        }
    }

    /// Adds direct light from all visible lights to at most [`PACKET_RAYS`] points.
    fn add_direct_light(
        &self,
        paths: &mut [PathState<T>],
        points: &mut [LitPoint<T>],
        policy: &impl RayEpsilonPolicy<T>,
    ) {
        let policy = &policy.for_shadow_rays();
        for (number, light) in self.lights.iter().enumerate() {
            // Points that face the light: index, direction to the light and cosine. `rays` holds their shadow
            // rays.
            let mut facing: SmallVec<[(usize, T::Vec3, T); PACKET_RAYS]> = SmallVec::new();
            let mut rays: SmallVec<[(Ray<T>, T); PACKET_RAYS]> = SmallVec::new();
            let mut push = |at: usize, direction: T::Vec3, cosine: T, shadow_ray: (Ray<T>, T)| {
                if cosine > T::zero() {
                    facing.push((at, direction, cosine));
                    rays.push(shadow_ray);
                }
            };
            if light.radius > T::zero() {
                for (at, point) in points.iter().enumerate() {
                    let cone = Cone::new(light.position, light.radius, point.hit.light_ray_origin(policy));
                    let (direction, distance) = cone.sample(paths[point.path].stream.next_disk());
                    let cosine = point.hit.normal.dot(direction);
                    let shadow_ray = (point.hit.spawn_ray(direction, policy), distance - policy.along());
                    push(at, direction, cosine, shadow_ray);
                }
            } else {
                for (chunk, chunk_points) in points.chunks(MAX_LANES).enumerate() {
                    self.point_light_rays(
                        chunk_points,
                        light,
                        policy,
                        |at, direction, cosine, shadow_ray| {
                            push(chunk * MAX_LANES + at, direction, cosine, shadow_ray);
                        },
                    );
                }
            }
            let hidden = if policy.acne().shadowed_lights >> number.min(31) & 1 != 0 {
                u64::MAX
            } else if light.shadow {
                self.occlusion_mask(&rays, light.surface, policy)
            } else {
                0
            };
            for (at, &(point, direction, cosine)) in facing.iter().enumerate() {
                if hidden >> at & 1 == 0 {
                    let LitPoint {
                        hit,
                        brdf,
                        color,
                        view,
                        ..
                    } = points[point];
                    let frame = Frame {
                        normal: hit.normal,
                        view,
                    };
                    let reflected = brdf.value(color, &frame, direction);
                    points[point].light = points[point].light + light.color * reflected * cosine;
                }
            }
        }
    }

    /// Computes, for at most [`MAX_LANES`] points and a point light, the direction, its cosine to the normal,
    /// the shadow ray and its length.
    fn point_light_rays(
        &self,
        from: &[LitPoint<T>],
        light: &Light<T>,
        policy: &impl RayEpsilonPolicy<T>,
        mut push: impl FnMut(usize, T::Vec3, T, (Ray<T>, T)),
    ) {
        let [mut points, mut normals] = [(); 2].map(|()| Columns::splat([T::zero(); 3]));
        for (at, point) in from.iter().enumerate() {
            points.set(at, point.hit.point.to_array());
            normals.set(at, point.hit.normal.to_array());
        }
        let mut output = LightDirections::zero();
        let kernel = ToPointLight {
            count: from.len(),
            points: &points,
            normals: &normals,
            light: light.position.to_array(),
            offset: policy.offset(),
            output: &mut output,
        };
        T::run(self.level_for(from.len()), kernel);
        for (at, point) in from.iter().enumerate() {
            let mut ray = Ray {
                origin: T::Vec3::from_array(output.shadow_rays[0].get(at)),
                direction: T::Vec3::from_array(output.shadow_rays[1].get(at)),
                from: Some(point.hit.surface),
            };
            let (mut direction, mut cosine) =
                (T::Vec3::from_array(output.directions.get(at)), output.cosines[at]);
            if policy.light_policy().from_ray_origin {
                direction = ray.direction;
                cosine = point.hit.normal.dot(direction);
            }
            ray.origin = ray.origin + ray.direction * policy.along();
            push(
                at,
                direction,
                cosine,
                (ray, output.distances[at] - policy.along()),
            );
        }
    }
}

/// Smallest number of secondary rays that are traced as a packet. Fewer rays are traced one by one, each
/// against eight spheres at a time.
const MIN_PACKET_RAYS: usize = 8;

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Returns the instruction set for `count` elements; a single one needs no vectors.
    pub(super) fn level_for(&self, count: usize) -> Level {
        if count == 1 { Level::Base } else { self.level }
    }

    fn uses_packet(&self, count: usize) -> bool {
        count >= MIN_PACKET_RAYS && !self.spheres.has_tree()
    }

    /// Finds the first hits of the secondary rays of some samples, at most [`PACKET_RAYS`].
    pub(super) fn find_first_hits(
        &self,
        paths: &mut [PathState<T>],
        indices: &[usize],
        policy: &impl RayEpsilonPolicy<T>,
    ) {
        if !self.uses_packet(indices.len()) {
            let self_hit_bounces = policy.acne().self_hit_bounces;
            for &at in indices {
                let Branch { ray, segments, .. } = &paths[at].branch;
                paths[at].first = match ray.from {
                    Some(own)
                        if self_hit_bounces != 0 && self_hit_bounces >> (segments - 2).min(31) & 1 != 0 =>
                    {
                        FirstHit::new(T::zero(), own as u32)
                    }
                    _ => self.nearest(ray, policy),
                };
            }
            return;
        }
        let rays = indices.iter().map(|&at| &paths[at].branch.ray);
        let packet = Packet::partial(
            rays.map(|ray| (ray, Self::own_surface(ray, policy))),
            policy.t_min(true),
        );
        let mut found = PacketHits::none();
        self.spheres.nearest_of_packet(&packet, &mut found);
        self.nearest_others_of_packet(&packet, &mut found, policy);
        for (at_packet, &at) in indices.iter().enumerate() {
            let path = &mut paths[at];
            path.first = found.get(at_packet);
            let ray = &path.branch.ray;
            if let Some(own) = self.own_other(ray, policy) {
                path.first
                    .update(self.shapes[own].intersect_own(ray, policy), own);
            }
        }
    }

    /// Evaluates [`World::occluded`] for at most [`PACKET_RAYS`] shadow rays with their lengths; `light` is
    /// the surface of the light, if any. Bit i is set if ray i is occluded.
    pub(super) fn occlusion_mask(
        &self,
        rays: &[(Ray<T>, T)],
        light: Option<usize>,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> u64 {
        let mut hidden = 0;
        if !self.uses_packet(rays.len()) || light.is_some() {
            for (at, (ray, distance)) in rays.iter().enumerate() {
                hidden |= u64::from(self.occluded(ray, *distance, light, policy)) << at;
            }
            return hidden;
        }
        let owned_rays = rays.iter().map(|(ray, _)| (ray, Self::own_surface(ray, policy)));
        let packet = Packet::partial(owned_rays, policy.t_min(true));
        let mut found = PacketHits::before(rays.iter().map(|&(_, distance)| distance));
        self.spheres.nearest_of_packet(&packet, &mut found);
        self.nearest_others_of_packet(&packet, &mut found, policy);
        for (at, (ray, distance)) in rays.iter().enumerate() {
            let own = || self.shapes[self.own_other(ray, policy)?].intersect_own(ray, policy);
            let is_hidden = found.is_before(at, *distance) || own().is_some_and(|t| t < *distance);
            hidden |= u64::from(is_hidden) << at;
        }
        hidden
    }

    /// Computes the points and normals where the rays of some samples hit spheres, at most [`MAX_LANES`].
    pub(super) fn compute_surfaces(
        &self,
        paths: &[PathState<T>],
        indices: &[usize],
        surfaces: &mut [Columns<T>; 2],
    ) {
        let [mut origins, mut directions, mut centers] = [(); 3].map(|()| Columns::splat([T::zero(); 3]));
        let mut ts = [T::zero(); MAX_LANES];
        for (lane, &at) in indices.iter().enumerate() {
            let PathState { branch, first, .. } = &paths[at];
            let Some((t, surface)) = first.get() else { continue };
            if let Some(sphere) = self.shapes[surface].sphere() {
                origins.set(lane, branch.ray.origin.to_array());
                directions.set(lane, branch.ray.direction.to_array());
                centers.set(lane, sphere.center.to_array());
                ts[lane] = t;
            }
        }
        let surfaces = Surfaces {
            count: indices.len(),
            origins: &origins,
            directions: &directions,
            t: &ts,
            centers: &centers,
            out: surfaces,
        };
        T::run(self.level, surfaces);
    }

    /// Like [`World::hit`], with the point and the normal of a sphere taken from a lane of `surfaces`.
    #[inline]
    pub(super) fn hit_in_lane(
        &self,
        [points, normals]: &[Columns<T>; 2],
        lane: usize,
        path: &PathState<T>,
    ) -> Option<Hit<T>> {
        let (_, surface) = path.first.get()?;
        if self.shapes[surface].sphere().is_none() {
            return self.hit(&path.branch.ray, path.first);
        }
        Some(Hit {
            point: T::Vec3::from_array(points.get(lane)),
            normal: T::Vec3::from_array(normals.get(lane)),
            surface,
        })
    }
}

const _: () = assert!(PACKET_RAYS == u64::BITS as usize);
