//! Light from the lights, by way of mirrors and glass: T. Whitted, “An Improved Illumination Model for Shaded
//! Display”, CACM 23(6), 1980. Each sample follows its rays one after the other, what glass mirrors before what it lets
//! through; several samples do so side by side.

use smallvec::SmallVec;

use super::super::lanes::{Columns, MOST_LANES};
use super::super::light::{Cone, Light, Toward, Ways};
use super::super::material::{Brdf, Frame, Glass, Meeting, Model};
use super::super::ray::{Hit, Ray};
use super::super::real::{Real, Vector};
use super::super::shape::Primitive;
use super::super::spheres::PACKET;
use super::super::style::Style;
use super::World;
use super::walk::{Aside, Branch, Walk};

/// A point that is lit.
struct Lit<'w, T: Real> {
    walk: usize,
    hit: Hit<T>,
    brdf: &'w Brdf<T>,
    color: T::Vec3,
    /// To where the ray came from.
    view: T::Vec3,
    light: T::Vec3,
}

/// A point of glass.
struct Parting<'w, T: Real> {
    walk: usize,
    hit: Hit<T>,
    glass: &'w Glass<T>,
    color: T::Vec3,
    /// Direction · normal.
    facing: T,
}

/// Where rays ended that bring nothing yet: at most [`PACKET`].
struct Ends<'w, T: Real> {
    lit: SmallVec<[Lit<'w, T>; PACKET]>,
    parting: SmallVec<[Parting<'w, T>; PACKET]>,
    /// Those samples that go on, by way of mirrors or with a ray that was put aside.
    going: SmallVec<[usize; PACKET]>,
}

impl<T: Real> Branch<T> {
    /// The ray that goes on from a point of that colour.
    fn follow(&self, hit: &Hit<T>, direction: T::Vec3, color: T::Vec3, style: &impl Style<T>) -> Self {
        Self {
            ray: hit.leave(direction, style),
            throughput: self.throughput * color,
            segments: self.segments + 1,
        }
    }
}

fn reflect<T: Real>(direction: T::Vec3, normal: T::Vec3, facing: T) -> T::Vec3 {
    direction - normal * (T::from_f64(2.0) * facing)
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Follows all rays of samples, at most [`PACKET`].
    pub(super) fn whitted(&self, walks: &mut [Walk<T>], style: &impl Style<T>) {
        let mut active: SmallVec<[usize; PACKET]> = (0..walks.len()).collect();
        let mut aside = Aside::new();
        let mut surfaces = [(); 2].map(|()| Columns::splat([T::zero(); 3]));
        let mut ends = Ends {
            lit: SmallVec::new(),
            parting: SmallVec::new(),
            going: SmallVec::new(),
        };
        while !active.is_empty() {
            for some in active.chunks(MOST_LANES) {
                let is_one = some.len() == 1;
                if !is_one {
                    self.put_surfaces(walks, some, &mut surfaces);
                }
                for (lane, &at) in some.iter().enumerate() {
                    let walk = &mut walks[at];
                    let hit = if is_one {
                        self.hit(&walk.branch.ray, walk.first)
                    } else {
                        self.hit_among(&surfaces, lane, walk)
                    };
                    self.scatter(at, walk, hit, &aside, &mut ends, style);
                }
            }
            for some in ends.parting.chunks(MOST_LANES) {
                self.part(walks, some, &mut aside, style);
                ends.going.extend(some.iter().map(|point| point.walk));
            }
            self.light(walks, &mut ends.lit, style);
            for point in &ends.lit {
                let walk = &mut walks[point.walk];
                walk.bring(point.light);
                if walk.turn(&aside) {
                    ends.going.push(point.walk);
                }
            }
            ends.lit.clear();
            ends.parting.clear();
            active.clear();
            std::mem::swap(&mut active, &mut ends.going);
            self.look(walks, &active, style);
        }
    }

    /// What comes of a ray that ends there.
    fn scatter<'w>(
        &'w self,
        at: usize,
        walk: &mut Walk<T>,
        hit: Option<Hit<T>>,
        aside: &Aside<T>,
        ends: &mut Ends<'w, T>,
        style: &impl Style<T>,
    ) {
        let Branch { ray, segments, .. } = walk.branch;
        let brought = if let Some(hit) = hit {
            let material = &self.materials[hit.surface];
            let color = material.color(hit.point);
            let facing = ray.direction.dot(hit.normal);
            match &material.model {
                Model::Facing => color * facing.abs(),
                Model::Emitter => color,
                Model::Reflective(brdf) => {
                    ends.lit.push(Lit {
                        walk: at,
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
                    walk.branch = walk.branch.follow(&hit, direction, color, style);
                    ends.going.push(at);
                    return;
                }
                Model::Glass(glass) => {
                    ends.parting.push(Parting {
                        walk: at,
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
        walk.bring(brought);
        if walk.turn(aside) {
            ends.going.push(at);
        }
    }

    /// Rays part at points of glass, at most [`MOST_LANES`]: what is mirrored is followed, what is refracted is put aside.
    fn part(
        &self,
        walks: &mut [Walk<T>],
        points: &[Parting<T>],
        aside: &mut Aside<T>,
        style: &impl Style<T>,
    ) {
        let mut meeting = Meeting::none();
        for point in points {
            let direction = walks[point.walk].branch.ray.direction;
            meeting.add(point.glass, direction, point.hit.normal, point.facing);
        }
        let parted = T::run(self.level(points.len()), &meeting);
        for (at, point) in points.iter().enumerate() {
            let walk = &mut walks[point.walk];
            let (branch, share) = (walk.branch, parted.shares[at]);
            let color = |share: T| point.color * share;
            if let Some(refracted) = parted.refracted(at) {
                let branch = branch.follow(&point.hit, refracted, color(T::one() - share), style);
                walk.put_aside(branch, aside);
            }
            let mirrored = reflect(branch.ray.direction, point.hit.normal, point.facing);
            walk.branch = branch.follow(&point.hit, mirrored, color(share), style);
        }
    }

    /// Adds the light of every light that is seen from points, at most [`PACKET`].
    fn light(&self, walks: &mut [Walk<T>], points: &mut [Lit<T>], style: &impl Style<T>) {
        let style = &style.of_light_rays();
        for (number, light) in self.lights.iter().enumerate() {
            // Those that face it: which, the direction to it and the cosine, and the way there.
            let mut facing: SmallVec<[(usize, T::Vec3, T); PACKET]> = SmallVec::new();
            let mut rays: SmallVec<[(Ray<T>, T); PACKET]> = SmallVec::new();
            let mut take = |at: usize, direction: T::Vec3, cosine: T, way: (Ray<T>, T)| {
                if cosine > T::zero() {
                    facing.push((at, direction, cosine));
                    rays.push(way);
                }
            };
            if light.radius > T::zero() {
                for (at, point) in points.iter().enumerate() {
                    let cone = Cone::new(light.position, light.radius, point.hit.lit_from(style));
                    let (direction, distance) = cone.draw(walks[point.walk].draws.polar());
                    let cosine = point.hit.normal.dot(direction);
                    let way = (point.hit.leave(direction, style), distance - style.along());
                    take(at, direction, cosine, way);
                }
            } else {
                for (chunk, some) in points.chunks(MOST_LANES).enumerate() {
                    self.toward(some, light, style, |at, direction, cosine, way| {
                        take(chunk * MOST_LANES + at, direction, cosine, way);
                    });
                }
            }
            let hidden = if style.acne().hidden_lights >> number.min(31) & 1 != 0 {
                u64::MAX
            } else if light.shadow {
                self.occluded_of(&rays, light.surface, style)
            } else {
                0
            };
            for (at, &(point, direction, cosine)) in facing.iter().enumerate() {
                if hidden >> at & 1 == 0 {
                    let Lit {
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

    /// The ways from points, at most [`MOST_LANES`], to a light that is a point: the direction, its cosine to the normal, the shadow
    /// ray and how far it goes.
    fn toward(
        &self,
        from: &[Lit<T>],
        light: &Light<T>,
        style: &impl Style<T>,
        mut take: impl FnMut(usize, T::Vec3, T, (Ray<T>, T)),
    ) {
        let [mut points, mut normals] = [(); 2].map(|()| Columns::splat([T::zero(); 3]));
        for (at, point) in from.iter().enumerate() {
            points.set(at, point.hit.point.to_array());
            normals.set(at, point.hit.normal.to_array());
        }
        let mut ways = Ways::nowhere();
        let toward = Toward {
            count: from.len(),
            points: &points,
            normals: &normals,
            light: light.position.to_array(),
            offset: style.offset(),
            ways: &mut ways,
        };
        T::run(self.level(from.len()), toward);
        for (at, point) in from.iter().enumerate() {
            let mut ray = Ray {
                origin: T::Vec3::from_array(ways.rays[0].get(at)),
                direction: T::Vec3::from_array(ways.rays[1].get(at)),
                from: Some(point.hit.surface),
            };
            let (mut direction, mut cosine) =
                (T::Vec3::from_array(ways.directions.get(at)), ways.cosines[at]);
            if style.lamp().from_start {
                direction = ray.direction;
                cosine = point.hit.normal.dot(direction);
            }
            ray.origin = ray.origin + ray.direction * style.along();
            take(at, direction, cosine, (ray, ways.distances[at] - style.along()));
        }
    }
}
