//! Everything that a ray can hit: geometries, groups of them, and instances of groups. The input of every backend.

use super::triangle_records::TriangleRecords;
use super::{GeometryId, GroupId, InstanceId, Shape};
use crate::error::{Error, Result};
use crate::math::{AnimatedTransform, Bounds3};

/// Whether a hit counts as soon as it is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opacity {
    /// Every hit counts.
    Opaque,
    /// A hit counts if the query's [`HitFilter`](crate::accel::HitFilter) accepts it (or there is none): alpha cut-outs.
    Filtered,
}

/// A shape and how rays see it.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// Its primitives.
    pub shape: Shape,
    /// Seen by rays that share a bit with this.
    pub mask: u32,
    /// Whether hits are filtered.
    pub opacity: Opacity,
}

impl Geometry {
    /// A geometry that every ray sees and none passes.
    pub fn opaque(shape: Shape) -> Self {
        Self {
            shape,
            mask: u32::MAX,
            opacity: Opacity::Opaque,
        }
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.shape.primitive_count()
    }

    /// A box around it over all times, in the space of its group.
    pub fn bounds(&self) -> Bounds3 {
        self.shape.bounds()
    }
}

/// Geometries and instances that can be instanced together.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// Its own geometries.
    pub geometries: Vec<GeometryId>,
    /// Other groups, placed in this one's space.
    pub instances: Vec<Instance>,
}

/// A group, placed.
#[derive(Clone, Debug)]
pub struct Instance {
    /// What is placed.
    pub group: GroupId,
    /// Where.
    pub world_from_object: AnimatedTransform,
    /// Seen by rays that share a bit with this (and with the geometry's).
    pub mask: u32,
}

/// Collects geometries and groups; [`WorldBuilder::build`] makes the [`World`].
#[derive(Clone, Debug, Default)]
pub struct WorldBuilder {
    geometries: Vec<Geometry>,
    groups: Vec<Group>,
    /// What is placed directly in world space.
    pub root: Group,
}

impl WorldBuilder {
    /// Adds a geometry, which a group (or [`WorldBuilder::root`]) must then name.
    pub fn add_geometry(&mut self, geometry: Geometry) -> GeometryId {
        self.geometries.push(geometry);
        GeometryId::from_index(self.geometries.len() - 1)
    }

    /// Adds a group. It may hold instances of groups added before, so that nothing can contain itself.
    pub fn add_group(&mut self, group: Group) -> GroupId {
        self.groups.push(group);
        GroupId::from_index(self.groups.len() - 1)
    }

    /// The world, with instances of instances flattened to one level: the depth that Debian's Embree is built for.
    ///
    /// # Errors
    /// [`Error::Usage`] if an id names nothing, if a group contains itself, or if two motions are nested whose product is no
    /// single motion (see [`AnimatedTransform::compose`]).
    pub fn build(self) -> Result<World> {
        self.check_ids()?;
        let mut instances = Vec::new();
        for instance in &self.root.instances {
            self.flatten(instance, &mut instances)?;
        }
        let mut members: Vec<Vec<GeometryId>> = self.groups.into_iter().map(|group| group.geometries).collect();
        let mut used = vec![false; members.len()];
        for instance in &instances {
            used[instance.group.index()] = true;
        }
        // A group that is only ever part of others, or never placed, needs no tree.
        for (group, used) in members.iter_mut().zip(used) {
            if !used {
                group.clear();
            }
        }
        Ok(World {
            records: TriangleRecords::of(&self.geometries, &self.root.geometries),
            geometries: self.geometries,
            root: self.root.geometries,
            groups: members,
            instances,
        })
    }

    fn check_ids(&self) -> Result<()> {
        for (index, group) in self.groups.iter().enumerate().chain([(self.groups.len(), &self.root)]) {
            if group.geometries.iter().any(|id| id.index() >= self.geometries.len()) {
                return Err(Error::Usage(format!(
                    "group {index} names a geometry that does not exist"
                )));
            }
            if group.instances.iter().any(|instance| instance.group.index() >= index) {
                return Err(Error::Usage(format!(
                    "group {index} instances itself or a group that is added later"
                )));
            }
        }
        Ok(())
    }

    fn flatten(&self, instance: &Instance, out: &mut Vec<Instance>) -> Result<()> {
        let group = &self.groups[instance.group.index()];
        if !group.geometries.is_empty() {
            out.push(instance.clone());
        }
        for inner in &group.instances {
            let Some(world_from_object) = instance.world_from_object.compose(&inner.world_from_object) else {
                return Err(Error::Usage(
                    "an instance that moves within a moving or unevenly scaled one is not supported".into(),
                ));
            };
            self.flatten(
                &Instance {
                    group: inner.group,
                    world_from_object,
                    mask: instance.mask & inner.mask,
                },
                out,
            )?;
        }
        Ok(())
    }
}

/// Everything that a ray can hit, in two levels: geometries in world space, and instances of groups of geometries.
#[derive(Clone, Debug)]
pub struct World {
    geometries: Vec<Geometry>,
    root: Vec<GeometryId>,
    groups: Vec<Vec<GeometryId>>,
    instances: Vec<Instance>,
    records: TriangleRecords,
}

impl World {
    /// All geometries, by [`GeometryId`].
    pub fn geometries(&self) -> &[Geometry] {
        &self.geometries
    }

    /// One geometry.
    #[inline]
    pub fn geometry(&self, id: GeometryId) -> &Geometry {
        &self.geometries[id.index()]
    }

    /// The geometries in world space.
    pub fn root(&self) -> &[GeometryId] {
        &self.root
    }

    /// The members of each group, by [`GroupId`]; those of a group that no instance places are left out.
    pub fn groups(&self) -> &[Vec<GeometryId>] {
        &self.groups
    }

    /// All instances, by [`InstanceId`].
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// One instance.
    #[inline]
    pub fn instance(&self, id: InstanceId) -> &Instance {
        &self.instances[id.index()]
    }

    /// What is known of triangles before they are hit.
    pub(super) fn triangle_records(&self) -> &TriangleRecords {
        &self.records
    }

    /// A box around the members of a group over all times, in its own space.
    pub fn group_bounds(&self, id: GroupId) -> Bounds3 {
        self.union_of(&self.groups[id.index()])
    }

    /// A box around everything over all times.
    pub fn bounds(&self) -> Bounds3 {
        let groups: Vec<_> = self.groups.iter().map(|members| self.union_of(members)).collect();
        self.instances
            .iter()
            .map(|instance| {
                instance
                    .world_from_object
                    .moving_bounds(&groups[instance.group.index()])
            })
            .fold(self.union_of(&self.root), Bounds3::union)
    }

    /// Whether anything in it moves.
    pub fn moves(&self) -> bool {
        let deforms = |geometry: &Geometry| matches!(&geometry.shape, Shape::Mesh(mesh) if mesh.is_moving());
        self.geometries.iter().any(deforms) || self.instances.iter().any(|i| !i.world_from_object.is_static())
    }

    /// Primitives with each instance of them counted.
    pub fn instanced_primitive_count(&self) -> u64 {
        let count = |members: &[GeometryId]| -> u64 {
            members
                .iter()
                .map(|&id| self.geometry(id).primitive_count() as u64)
                .sum()
        };
        let groups: Vec<u64> = self.groups.iter().map(|members| count(members)).collect();
        count(&self.root)
            + self
                .instances
                .iter()
                .map(|instance| groups[instance.group.index()])
                .sum::<u64>()
    }

    /// Bytes of the geometries' arrays, and of what is known of triangles before they are hit.
    pub fn memory(&self) -> usize {
        let shapes = self.geometries.iter().map(|geometry| geometry.shape.memory());
        shapes.sum::<usize>() + size_of_val(self.instances.as_slice()) + self.records.memory()
    }

    fn union_of(&self, members: &[GeometryId]) -> Bounds3 {
        members
            .iter()
            .map(|&id| self.geometry(id).bounds())
            .fold(Bounds3::EMPTY, Bounds3::union)
    }
}
