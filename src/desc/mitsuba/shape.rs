//! Shapes, groups of shapes, and instances of them.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::bsdf::Surface;
use super::graph::{Object, ObjectIndex};
use super::loader::Loader;
use super::mesh::MeshFile;
use super::plugins::Class;
use super::props::Props;
use super::solids;
use crate::desc::{
    AreaLightDesc, InstanceDesc, MeshDesc, MotionDesc, ObjectDesc, ObjectId, ShapeDesc, ShapeKind, Textured,
};

/// What a shape is, where, and whether its normals are turned.
struct Form {
    kind: ShapeKind,
    world_from_object: DAffine3,
    reverse_orientation: bool,
}

impl<'g> Loader<'g> {
    /// A shape of the scene.
    pub fn shape(&mut self, index: ObjectIndex, object: &'g Object) {
        match object.plugin.as_str() {
            "shapegroup" => {
                self.group(index, object);
            }
            "instance" => self.instance(object),
            _ => {
                if let Some(shape) = self.one_shape(object) {
                    self.shapes.push(shape);
                }
            }
        }
    }

    /// One shape that is neither group nor instance; none if there is nothing to be seen of it, or if it is wrong, which is said.
    fn one_shape(&mut self, object: &'g Object) -> Option<ShapeDesc> {
        let mut props = Props::new(object);
        let form = self.form(&mut props);
        let media = self.media_of(&mut props);
        for (_, sensor) in self.children(&mut props, Class::Sensor) {
            props.unsupported(sensor.span, "a sensor on a shape is not supported", "it is left out");
        }
        let bsdf = self.child(&mut props, Class::Bsdf);
        let emitter = self.child(&mut props, Class::Emitter);
        props.ignore(&["silhouette_sampling_weight"]);
        props.finish(self.report());
        let area_light = emitter.and_then(|(_, emitter)| self.area_light(emitter));
        let surface = match bsdf {
            Some((index, _)) => self.surface(index),
            None => Some(self.default_surface(emitter.is_some())),
        };
        let media = media.filter(|media| media.interior != media.exterior);
        let surface = match surface {
            None if media.is_some() && area_light.is_none() => Some(Surface {
                material: self.boundary(object.span),
                alpha: Textured::Value(1.0),
            }),
            surface => surface,
        };
        let Some(Surface { material, alpha }) = surface else {
            self.nothing_to_see(object, area_light.as_ref());
            return None;
        };
        if area_light.is_some() && alpha != Textured::Value(1.0) {
            let message = "a `mask` on a shape that emits masks what it emits, too (in Mitsuba it does not)";
            self.report().warning(object.span, message);
        }
        let form = form?;
        if let Some((index, _)) = bsdf {
            self.check_attributes(index, object, &form.kind);
        }
        Some(ShapeDesc {
            span: object.span,
            kind: form.kind,
            world_from_object: MotionDesc::fixed(form.world_from_object),
            reverse_orientation: form.reverse_orientation,
            material,
            media,
            alpha,
            area_light,
        })
    }

    /// A shape whose bsdf is `null`.
    fn nothing_to_see(&mut self, object: &Object, light: Option<&AreaLightDesc>) {
        if self.report().has_errors() {
            return;
        }
        if light.is_some() {
            let message = "a shape that emits and has the bsdf `null` is not supported";
            self.report().unsupported(object.span, message, "it is left out");
        } else {
            let message = "this shape is left out: with the bsdf `null` and the same on both sides it does nothing";
            self.report().warning(object.span, message);
        }
    }

    /// The geometry by the plugin.
    fn form(&mut self, props: &mut Props<'g>) -> Option<Form> {
        let object = props.object;
        let to_world = props.transform("to_world");
        let flip = props.boolean("flip_normals", false);
        // Faces are oriented by how their vertices go round in the world, where a mirror turns them; solids keep their outside.
        let mirrors = to_world.matrix3.determinant() < 0.0;
        let (kind, local, reverse) = match object.plugin.as_str() {
            "rectangle" => (mesh(solids::rectangle()), DAffine3::IDENTITY, flip),
            "cube" => {
                props.ignore(&["face_normals"]);
                (mesh(solids::cube()), DAffine3::IDENTITY, flip)
            }
            "disk" => (solids::DISK, DAffine3::IDENTITY, flip),
            "cylinder" => (solids::CYLINDER, cylinder(props), flip),
            "sphere" => {
                let center = props.vector("center").unwrap_or(DVec3::ZERO);
                let radius = props.positive("radius", 1.0);
                (ShapeKind::Sphere { radius }, DAffine3::from_translation(center), flip)
            }
            "linearcurve" | "bsplinecurve" => {
                return Some(Form {
                    kind: self.curves(props, &to_world)?,
                    world_from_object: DAffine3::IDENTITY,
                    reverse_orientation: flip,
                });
            }
            "obj" | "ply" | "serialized" => {
                let file = MeshFile::of(props, self.graph, &self.xml)?;
                match self.meshes.get(&file) {
                    Ok(read) => {
                        let kind = ShapeKind::TriangleMesh(read.mesh);
                        (kind, DAffine3::IDENTITY, flip ^ (mirrors && !read.own_normals))
                    }
                    Err(problem) => {
                        props.error(props.span_of("filename"), problem);
                        return None;
                    }
                }
            }
            _ => {
                self.refuse(object, "it is left out");
                props.objects(|_| true);
                return None;
            }
        };
        Some(Form {
            kind,
            world_from_object: to_world * local,
            reverse_orientation: reverse,
        })
    }

    /// A `shapegroup`, once however many instances it has; none if something is wrong with it, which is said.
    fn group(&mut self, index: ObjectIndex, object: &'g Object) -> Option<ObjectId> {
        if let Some(&id) = self.groups.get(&index) {
            return Some(id);
        }
        let mut props = Props::new(object);
        let mut shapes = Vec::new();
        for (_, child) in self.children(&mut props, Class::Shape) {
            if matches!(child.plugin.as_str(), "shapegroup" | "instance") {
                props.unsupported(child.span, "a group inside a group is not supported", "it is left out");
                continue;
            }
            if let Some(mut shape) = self.one_shape(child) {
                if let Some(light) = shape.area_light.take() {
                    props.error(light.span, "a shape of a `shapegroup` cannot emit");
                }
                shapes.push(shape);
            }
        }
        props.transform("to_world");
        props.finish(self.report());
        let name = object
            .id
            .clone()
            .unwrap_or_else(|| format!("group{}", self.objects.len() + 1));
        self.objects.push(ObjectDesc {
            name,
            shapes,
            span: object.span,
        });
        let id = ObjectId(self.objects.len() as u32 - 1);
        self.groups.insert(index, id);
        Some(id)
    }

    fn instance(&mut self, object: &'g Object) {
        let mut props = Props::new(object);
        let to_world = props.transform("to_world");
        let child = self.child(&mut props, Class::Shape);
        let group = child.filter(|(_, group)| group.plugin == "shapegroup");
        if group.is_none() {
            props.error(object.span, "an `instance` needs a `<ref>` to a `shapegroup`");
        }
        props.finish(self.report());
        if let Some((index, group)) = group
            && let Some(id) = self.group(index, group)
        {
            self.instances.push(InstanceDesc {
                object: id,
                world_from_instance: MotionDesc::fixed(to_world),
                span: object.span,
            });
        }
    }
}

fn mesh(mesh: MeshDesc) -> ShapeKind {
    ShapeKind::TriangleMesh(Arc::new(mesh))
}

/// From the unit cylinder to one from `p1` to `p0`, which turns v round.
fn cylinder(props: &mut Props<'_>) -> DAffine3 {
    let p0 = props.vector("p0").unwrap_or(DVec3::ZERO);
    let p1 = props.vector("p1").unwrap_or(DVec3::Z);
    let radius = props.positive("radius", 1.0);
    let axis = p1 - p0;
    if axis == DVec3::ZERO {
        props.error(props.span_of("p1"), "`p0` and `p1` of a cylinder must differ");
        return DAffine3::IDENTITY;
    }
    let turn = DMat3::from_quat(DQuat::from_rotation_arc(DVec3::Z, axis.normalize()));
    let scale = DMat3::from_diagonal(DVec3::new(radius, radius, -axis.length()));
    DAffine3::from_mat3_translation(turn * scale, p1)
}
