//! All queries give the bits of testing one ray against one sphere after the other.

use glam::DVec3;
use toyproof_image::pcg;
use toyproof_scene::unit as unit_interval;

use super::binary::BinaryTree;
use super::*;
use crate::lanes::{Kernel, Lanes, Level, Wide, Wide3, lanes_of};
use crate::ray::Ray;
use crate::real::{Real, Vector};

/// Reproducible random numbers, by hashing.
struct Random(u32);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = pcg(self.0);
        low + (high - low) * unit_interval(self.0)
    }

    /// Returns an integer in 0 … number − 1.
    fn below(&mut self, number: u32) -> u32 {
        self.between(0.0, f64::from(number)) as u32
    }

    fn place(&mut self, size: f64) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.between(-size, size)))
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.place(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// Spheres of a scene: separate, overlapping, nested, duplicated, and one very large one.
fn scene(random: &mut Random, count: u32, scale: f64) -> Vec<(DVec3, f64)> {
    let size = 10.0 * scale;
    let mut spheres: Vec<(DVec3, f64)> = Vec::new();
    for _ in 0..count {
        let radius = scale * 10f64.powf(random.between(-3.0, 0.5));
        let sphere = match (random.below(12), spheres.last()) {
            (0, Some(&last)) => last,
            (1, Some(&(center, radius))) => (center, 0.5 * radius),
            (2, _) => (DVec3::new(0.0, -1001.0 * size, 0.0), 1000.0 * size),
            _ => (random.place(size), radius),
        };
        spheres.push(sphere);
    }
    spheres
}

/// Chooses a target for a ray from `origin`: in any direction, along an axis, or near the silhouette of a
/// sphere.
fn target(random: &mut Random, spheres: &[(DVec3, f64)], origin: DVec3) -> DVec3 {
    let (center, radius) = spheres[random.below(spheres.len() as u32) as usize];
    let toward = center - origin;
    let across = toward.cross(random.direction()).normalize_or(DVec3::X);
    match random.below(5) {
        0 => origin + random.direction(),
        1 => origin + [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z][random.below(3) as usize],
        2 => center + across * (radius * (1.0 + random.between(-1e-6, 1e-6))),
        _ => center + across * (radius * random.between(0.0, 1.5)),
    }
}

fn rounded<T: Real>(v: DVec3) -> [T; 3] {
    v.to_array().map(T::from_f64)
}

fn toward<T: Real>(origin: DVec3, target: DVec3) -> [T; 3] {
    // Scale first: squares of the smallest numbers underflow.
    let away = target - origin;
    rounded((away / away.abs().max_element()).normalize_or(DVec3::NEG_Z))
}

/// Tests one sphere after the other; the ray starts on the sphere `own`.
fn oracle<T: Real>(spheres: &[NumberedSphere<T>], query: &Query<T>, own: u32) -> Option<(T, u32)> {
    let mut nearest: Option<(T, u32)> = None;
    for sphere in spheres
        .iter()
        .filter(|sphere| !query.excluded.contains(&sphere.number))
    {
        let kernel = IntersectSphere {
            origin: query.origin,
            direction: query.direction,
            center: sphere.center,
            radius: sphere.radius,
            t_min: query.t_min,
            is_own: sphere.number == own,
        };
        if let Some(t) = T::run(Level::Base, kernel)
            && t < query.t_max
            && nearest.is_none_or(|(before, _)| t < before)
        {
            nearest = Some((t, sphere.number));
        }
    }
    nearest
}

fn hit_of<T: Real>(found: &PacketHits<T>, ray: usize) -> Option<(T, u32)> {
    found.get(ray).get().map(|(t, surface)| (t, surface as u32))
}

fn numbered<T: Real>(described: &[(DVec3, f64)], number: impl Fn(u32) -> u32) -> Vec<NumberedSphere<T>> {
    (0..)
        .zip(described)
        .map(|(at, &(center, radius))| NumberedSphere {
            center: rounded(center),
            radius: T::from_f64(radius),
            number: number(at),
        })
        .collect()
}

/// Compares all query paths and returns the number of rays and of hits. The size of the scene is
/// 10^±`exponents`; rays start at up to 10^`away` times the size from its center.
fn compare<T: Real>(seeds: u32, exponents: f64, away: f64) -> [u32; 2] {
    let mut counts = [0; 2];
    for seed in 0..seeds {
        let random = &mut Random(seed);
        let scale = 10f64.powf(random.between(-exponents, exponents));
        let count = [1, 3, 8, 9, 20, 150][random.below(6) as usize];
        let described = scene(random, count, scale);
        // Indices not in storage order.
        let spheres = numbered::<T>(&described, |number| number ^ 1);
        let mut sorted = spheres.clone();
        sorted.sort_by_key(|sphere| sphere.number);
        let distance = scale * 10f64.powf(random.between(0.0, away));
        let eye = random.place(distance);
        let is_narrow = random.below(2) == 0;
        let aim = target(random, &described, eye);
        let rays: [_; PACKET_RAYS] = std::array::from_fn(|_| {
            let target = if is_narrow {
                aim + random.place(0.1 * scale)
            } else {
                target(random, &described, eye)
            };
            let start = eye + random.place(scale);
            (start, toward::<T>(eye, target), random.below(count))
        });
        let query = |at: usize, origin: DVec3| Query {
            origin: rounded(origin),
            direction: rays[at].1,
            t_min: T::zero(),
            t_max: T::infinity(),
            number: 0,
            excluded: [NO_SURFACE; 2],
        };
        let directions = [0, 1, 2].map(|axis| std::array::from_fn(|at| rays[at].1[axis]));
        let packets = [
            Packet::full(Origins::Shared(rounded(eye)), directions),
            Packet::full(
                Origins::Each([0, 1, 2].map(|axis| std::array::from_fn(|at| rounded::<T>(rays[at].0)[axis]))),
                directions,
            ),
        ];
        let expected = [0, 1].map(|kind| {
            [(); PACKET_RAYS]
                .iter()
                .enumerate()
                .map(|(at, ())| {
                    let origin = if kind == 0 { eye } else { rays[at].0 };
                    oracle(&sorted, &query(at, origin), NO_SURFACE)
                })
                .collect::<Vec<_>>()
        });
        for (level, tree) in Level::all().flat_map(|level| [(level, false), (level, true)]) {
            let case = format!("seed {seed}, {level:?}, tree: {tree}");
            let all = Spheres::new(&spheres, tree, level);
            for (packet, expected) in packets.iter().zip(&expected) {
                let mut found = PacketHits::none();
                all.nearest_of_packet(packet, &mut found);
                for (at, expected) in expected.iter().enumerate() {
                    assert_eq!(hit_of(&found, at), *expected, "{case}, ray {at} of a packet");
                }
            }
            for (at, &expected) in expected[1].iter().enumerate() {
                let (start, _, excluded) = rays[at];
                let mut query = query(at, start);
                assert_eq!(all.nearest(&query), expected, "{case}, ray {at}");
                assert_eq!(all.any(&query), expected.is_some(), "{case}, ray {at}");
                counts[0] += 1;
                let Some((t, number)) = expected else { continue };
                counts[1] += 1;
                // No hit before t; another hit may remain without the sphere, or beyond its t.
                query.t_max = t;
                assert!(!all.any(&query), "{case}, ray {at}");
                // At t, the sphere counts if it comes before the given one.
                query.number = number + 1;
                assert_eq!(all.nearest(&query), expected, "{case}, ray {at}");
                query.number = number;
                assert_eq!(all.nearest(&query), None, "{case}, ray {at}");
                (query.t_max, query.number) = (T::infinity(), 0);
                query.excluded = [excluded, number];
                assert_eq!(
                    all.nearest(&query),
                    oracle(&sorted, &query, NO_SURFACE),
                    "{case}, ray {at}"
                );
                query.excluded = [NO_SURFACE; 2];
                query.t_min = t;
                assert_eq!(
                    all.nearest(&query),
                    oracle(&sorted, &query, NO_SURFACE),
                    "{case}, ray {at}"
                );
            }
        }
    }
    counts
}

/// Compares rays that start on spheres, with a lower bound of t, and occlusion up to a given t. Returns the
/// number of rays and of hits of their own sphere.
fn compare_secondary<T: Real>(seeds: u32, exponents: f64) -> [u32; 2] {
    let mut counts = [0; 2];
    for seed in 0..seeds {
        let random = &mut Random(seed);
        let scale = 10f64.powf(random.between(-exponents, exponents));
        let count = [1, 3, 8, 9, 20, 100][random.below(6) as usize];
        let described = scene(random, count, scale);
        let spheres = numbered::<T>(&described, |number| number);
        let t_min = T::from_f64([0.0, scale * random.between(0.0, 1.0)][random.below(2) as usize]);
        let rays: Vec<(Ray<T>, Option<u32>)> = (0..=random.below(PACKET_RAYS as u32))
            .map(|at| {
                let own = random.below(count);
                let (center, radius) = described[own as usize];
                let start = center + random.direction() * radius;
                let ray = Ray {
                    origin: T::Vec3::from_array(rounded(start)),
                    direction: T::Vec3::from_array(toward::<T>(start, target(random, &described, start))),
                    from: None,
                };
                (ray, (at % 4 != 3).then_some(own))
            })
            .collect();
        let expected: Vec<_> = rays
            .iter()
            .map(|(ray, own)| {
                let query = Query {
                    origin: ray.origin.to_array(),
                    direction: ray.direction.to_array(),
                    t_min,
                    t_max: T::infinity(),
                    number: 0,
                    excluded: [NO_SURFACE; 2],
                };
                oracle(&spheres, &query, own.unwrap_or(NO_SURFACE))
            })
            .collect();
        let factors = [0.5, 1.0, 1.5].map(T::from_f64);
        let limits: Vec<_> = (expected.iter().enumerate())
            .map(|(at, expected)| expected.map_or(T::one(), |(t, _)| t) * factors[at % 3])
            .collect();
        let owned = |at: usize| rays.get(at).unwrap_or(&rays[0]);
        let component = |of: fn(&Ray<T>) -> T::Vec3| {
            [0, 1, 2].map(|axis| std::array::from_fn(|at| of(&owned(at).0).to_array()[axis]))
        };
        let [origins, directions] = [component(|ray| ray.origin), component(|ray| ray.direction)];
        for level in Level::all() {
            let all = Spheres::new(&spheres, false, level);
            let in_lanes = InLanes {
                spheres: &all,
                origins: &origins,
                directions: &directions,
                from: std::array::from_fn(|at| T::tag(owned(at).1.unwrap_or(NO_SURFACE))),
                t_min,
                limits: std::array::from_fn(|at| limits.get(at).copied().unwrap_or(T::one())),
                ignored: std::array::from_fn(|at| {
                    T::tag(
                        expected
                            .get(at)
                            .copied()
                            .flatten()
                            .map_or(NO_SURFACE, |(_, number)| number),
                    )
                }),
            };
            let [found, limited, without] = T::run(level, in_lanes);
            for (at, (&expected, &limit)) in expected.iter().zip(&limits).enumerate() {
                let case = format!("seed {seed}, {level:?}, ray {at}");
                let (t, surface) = (found[at][0], found[at][1].untag());
                assert_eq!((t < T::infinity()).then_some((t, surface)), expected, "{case}");
                let is_before = expected.is_some_and(|(t, _)| t < limit);
                assert_eq!(limited[at][0] == T::one(), is_before, "{case}");
                let (ray, own) = &rays[at];
                let query = Query {
                    origin: ray.origin.to_array(),
                    direction: ray.direction.to_array(),
                    t_min,
                    t_max: limit,
                    number: 0,
                    excluded: [expected.map_or(NO_SURFACE, |(_, number)| number), NO_SURFACE],
                };
                let other = oracle(&spheres, &query, own.unwrap_or(NO_SURFACE));
                assert_eq!(
                    without[at][0] == T::one(),
                    other.is_some(),
                    "{case}, without its sphere"
                );
                counts[0] += 1;
                counts[1] += u32::from(expected.is_some_and(|(_, number)| Some(number) == rays[at].1));
            }
        }
    }
    counts
}

/// Kernel that traces rays in lanes.
struct InLanes<'a, T> {
    spheres: &'a Spheres<T>,
    origins: &'a [[T; PACKET_RAYS]; 3],
    directions: &'a [[T; PACKET_RAYS]; 3],
    from: [T; PACKET_RAYS],
    t_min: T,
    limits: [T; PACKET_RAYS],
    ignored: [T; PACKET_RAYS],
}

impl<T: Real> Kernel<T> for InLanes<'_, T> {
    /// For each ray: t and the surface of the nearest hit; 1 if there is a hit before its limit, else 0; the
    /// same without the sphere `ignored`.
    type Output = [[[T; 2]; PACKET_RAYS]; 3];

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Self::Output {
        let mut output = [[[T::zero(); 2]; PACKET_RAYS]; 3];
        let t_min = Wide::splat(simd, self.t_min);
        for at in (0..PACKET_RAYS).step_by(S::COUNT) {
            let rays = LaneRays {
                origin: Wide3::load(simd, self.origins, at),
                direction: Wide3::load(simd, self.directions, at),
                from: Wide::load(simd, &self.from[at..]),
            };
            let limits = Wide::load(simd, &self.limits[at..]);
            let no_surface = Wide::splat(simd, T::tag(NO_SURFACE));
            let ignored = Wide::load(simd, &self.ignored[at..]);
            // Two sets of lanes that together are all: those outside of `active` must have no effect.
            for active in [0x5555, 0xaaaa].map(|lanes| lanes & (u32::MAX >> (32 - S::COUNT))) {
                let hits = self.spheres.nearest_in_lanes(simd, &rays, t_min, active);
                let [t, surface] = [hits.t.to_array(), hits.surface.to_array()];
                let limits = [t_min, limits];
                let before = self.spheres.any_in_lanes(simd, &rays, limits, no_surface, active);
                let without = self.spheres.any_in_lanes(simd, &rays, limits, ignored, active);
                for lane in lanes_of(active) {
                    let flag = |bits: u32| {
                        [if bits >> lane & 1 != 0 {
                            T::one()
                        } else {
                            T::zero()
                        }; 2]
                    };
                    output[0][at + lane] = [t[lane], surface[lane]];
                    output[1][at + lane] = flag(before);
                    output[2][at + lane] = flag(without);
                }
            }
        }
        output
    }
}

#[test]
fn secondary_rays_in_lanes_match_single_rays() {
    for [rays, own] in [
        compare_secondary::<f32>(1500, 15.0),
        compare_secondary::<f64>(1500, 30.0),
    ] {
        assert!(own > rays / 50, "{own} of {rays} rays hit their own sphere again");
    }
}

#[test]
fn every_way_gives_the_same_bits_at_every_size() {
    for [rays, hits] in [
        compare::<f32>(1500, 30.0, 3.0),
        compare::<f64>(1500, 30.0, 3.0),
        compare::<f64>(300, 150.0, 3.0),
    ] {
        assert!(
            hits > rays / 4 && hits < rays,
            "{hits} of {rays} rays hit something"
        );
    }
}

/// At this distance, rounding moves rays past spheres that they hit and into others, which the margins of
/// boxes must cover.
#[test]
fn all_queries_give_the_same_bits_from_far_away() {
    for [_, hits] in [compare::<f32>(300, 3.0, 8.0), compare::<f64>(100, 3.0, 16.0)] {
        assert!(hits > 300, "{hits}");
    }
}

#[test]
fn nan_ray_does_not_affect_other_rays_of_a_packet() {
    let spheres: Vec<_> = (0..200u32)
        .map(|number| NumberedSphere {
            center: [f64::from(number % 20) - 10.0, f64::from(number / 20) - 5.0, -20.0],
            radius: 0.4,
            number,
        })
        .collect();
    let grid = |at: usize| f64::from(at as u32) - 4.0;
    let directions = [
        std::array::from_fn(|at| grid(at % 8)),
        std::array::from_fn(|at| grid(at / 8)),
        [-20.0; PACKET_RAYS],
    ];
    for (level, tree) in Level::all().flat_map(|level| [(level, false), (level, true)]) {
        let all = Spheres::new(&spheres, tree, level);
        let found = |directions| {
            let origins = Origins::Shared([0.0; 3]);
            let mut found = PacketHits::none();
            all.nearest_of_packet(&Packet::full(origins, directions), &mut found);
            (1..PACKET_RAYS).map(|at| hit_of(&found, at)).collect::<Vec<_>>()
        };
        let before = found(directions);
        assert!(before.iter().flatten().count() > 10);
        let mut broken = directions;
        broken[1][0] = f64::NAN;
        assert_eq!(found(broken), before);
    }
}

/// Each sphere is in one leaf, whatever the spheres are: in one place, on a line in growing distances, or
/// without a place.
#[test]
fn leaves_partition_the_spheres() {
    let mut random = Random(3);
    let scattered: Vec<_> = (0..500).map(|_| (random.place(10.0).to_array(), 0.1)).collect();
    let nested = (0..100).map(|at| ([1.0; 3], 0.5f64.powi(at)));
    let growing = (0..400).map(|at| ([2f64.powi(at), 0.0, 0.0], 0.1));
    let odd = (0..100).map(|at| ([f64::NAN, f64::from(at % 7), f64::INFINITY], f64::from(at)));
    let sets: [Vec<_>; 6] = [
        scattered.clone(),
        nested.clone().collect(),
        growing.clone().collect(),
        odd.clone().collect(),
        scattered.into_iter().chain(nested).chain(growing).collect(),
        odd.take(9).collect(),
    ];
    for (set, spheres) in sets.iter().enumerate() {
        let spheres: Vec<_> = (0..)
            .zip(spheres)
            .map(|(number, &(center, radius))| NumberedSphere {
                center,
                radius,
                number,
            })
            .collect();
        let tree = BinaryTree::build(&spheres);
        let leaves: Vec<_> = (0..tree.len())
            .filter(|&node| tree.halves(node).is_none())
            .map(|node| tree.spheres(node))
            .collect();
        assert_eq!(leaves.len(), tree.leaves(), "set {set}");
        assert!(
            leaves.iter().all(|leaf| (1..=BLOCK_SIZE).contains(&leaf.len())),
            "set {set}"
        );
        let mut all = leaves.concat();
        all.sort_unstable();
        assert_eq!(all, (0..spheres.len() as u32).collect::<Vec<_>>(), "set {set}");
    }
}
