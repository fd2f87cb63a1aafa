//! Bsdfs to materials.

use super::graph::{Object, ObjectIndex};
use super::ior::Metal;
use super::loader::{Loader, constant, grey};
use super::props::Props;
use super::spectrum::Use;
use crate::desc::{
    ConductorDesc, DistributionDesc, MaterialDesc, MaterialId, MaterialKind, PlasticDesc, PrincipledDesc,
    RoughnessDesc, SpectrumDesc, SpectrumValue, Textured,
};
use crate::error::Span;

/// What a bsdf does, apart from which side it does it on.
#[derive(Clone, Debug)]
pub(super) struct Scattering {
    pub material: MaterialId,
    /// Whether it is black from behind unless it is inside a `twosided`.
    pub one_sided: bool,
    /// How much of it there is.
    pub alpha: Textured<f32>,
}

/// What a shape is made of.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub material: MaterialId,
    /// How much of it there is.
    pub alpha: Textured<f32>,
}

const STAND_IN: &str = "a diffuse one of reflectance 0.5 stands in";

impl<'g> Loader<'g> {
    /// The surface of a shape with this bsdf; `None` if it has none.
    pub fn surface(&mut self, index: ObjectIndex) -> Option<Surface> {
        let scattering = self.scattering(index)?;
        Some(Surface {
            material: self.closed(&scattering),
            alpha: scattering.alpha,
        })
    }

    /// The surface of a shape without a bsdf: black if it emits.
    pub fn default_surface(&mut self, emits: bool) -> Surface {
        if let Some(surface) = &self.default_surfaces[usize::from(emits)] {
            return surface.clone();
        }
        let reflectance = if emits { 0.0 } else { 0.5 };
        let span = self.graph.objects[0].span;
        let MaterialDesc { kind, .. } = grey(reflectance, span);
        let material = self.add_material(kind, span);
        let surface = Surface {
            material: self.front_only(material, span),
            alpha: Textured::Value(1.0),
        };
        self.default_surfaces[usize::from(emits)] = Some(surface.clone());
        surface
    }

    /// The material of what is only a boundary between media.
    pub fn boundary(&mut self, span: Span) -> MaterialId {
        let id = match self.boundary {
            Some(id) => id,
            None => self.add_material(MaterialKind::Interface, span),
        };
        self.boundary = Some(id);
        id
    }

    /// A bsdf as it is inside a `twosided`, each translated once; `None` for `null`, and for what cannot be translated, which is said.
    pub fn scattering(&mut self, index: ObjectIndex) -> Option<Scattering> {
        if let Some(scattering) = self.scattering.get(&index) {
            return scattering.clone();
        }
        let object = self.graph.object(index);
        let mut props = Props::new(object);
        let scattering = self.translate(object, &mut props);
        props.finish(self.report());
        self.scattering.insert(index, scattering.clone());
        scattering
    }

    /// The material with its sides.
    pub fn closed(&mut self, scattering: &Scattering) -> MaterialId {
        if !scattering.one_sided {
            return scattering.material;
        }
        let span = self.materials[scattering.material.0 as usize].span;
        self.front_only(scattering.material, span)
    }

    fn front_only(&mut self, material: MaterialId, span: Span) -> MaterialId {
        if let Some(&id) = self.one_sided.get(&material) {
            return id;
        }
        let id = self.add_material(
            MaterialKind::Sided {
                front: Some(material),
                back: None,
            },
            span,
        );
        self.one_sided.insert(material, id);
        id
    }

    fn translate(&mut self, object: &'g Object, props: &mut Props<'g>) -> Option<Scattering> {
        let (kind, one_sided) = match object.plugin.as_str() {
            "twosided" => return self.two_sided(props),
            "mask" => return self.mask(props),
            "blendbsdf" => return self.blend(props),
            "bumpmap" | "normalmap" => return self.relief(props),
            "null" => return None,
            "diffuse" => {
                let reflectance = props.take("reflectance");
                let kind = MaterialKind::Diffuse {
                    reflectance: self.color(reflectance, 0.5, object.span, Use::Albedo),
                    roughness: Textured::Value(0.0),
                };
                (kind, true)
            }
            "conductor" => (self.conductor(props, smooth()), true),
            "roughconductor" => {
                let roughness = self.roughness(props);
                (self.conductor(props, roughness), true)
            }
            "dielectric" => (self.dielectric(props, smooth()), false),
            "roughdielectric" => {
                let roughness = self.roughness(props);
                (self.dielectric(props, roughness), false)
            }
            "thindielectric" => {
                let eta = self.relative_ior(props, "bk7");
                (
                    MaterialKind::ThinDielectric {
                        eta: number(eta, object.span),
                    },
                    false,
                )
            }
            "plastic" => (self.plastic(props, None), true),
            "roughplastic" => {
                let roughness = self.roughness(props);
                if roughness.u != roughness.v || matches!(roughness.u, Textured::Texture(_)) {
                    props.error(props.span_of("alpha"), "the `alpha` of `roughplastic` is a number");
                }
                (self.plastic(props, Some(roughness)), true)
            }
            "principled" => self.principled(props),
            _ => {
                self.refuse(object, STAND_IN);
                props.objects(|_| true);
                (grey(0.5, object.span).kind, true)
            }
        };
        let material = self.add_material(kind, object.span);
        let tinted = matches!(
            object.plugin.as_str(),
            "conductor" | "roughconductor" | "dielectric" | "roughdielectric" | "thindielectric"
        );
        Some(Scattering {
            material: if tinted { self.tinted(props, material) } else { material },
            one_sided,
            alpha: Textured::Value(1.0),
        })
    }

    /// The material, with what it reflects and transmits multiplied.
    fn tinted(&mut self, props: &mut Props<'g>, material: MaterialId) -> MaterialId {
        let transmits = props.object.plugin.contains("dielectric");
        let reflectance = props.take("specular_reflectance");
        let transmittance = if transmits {
            props.take("specular_transmittance")
        } else {
            None
        };
        let given = [reflectance, transmittance].map(|p| p.filter(|p| !Self::is_number(p, 1.0)));
        if given.iter().all(Option::is_none) {
            return material;
        }
        let span = props.object.span;
        let [reflectance, transmittance] = given.map(|property| self.color(property, 1.0, span, Use::Albedo));
        self.add_material(
            MaterialKind::Tinted {
                material,
                reflectance,
                transmittance,
            },
            span,
        )
    }

    fn conductor(&mut self, props: &mut Props<'g>, roughness: RoughnessDesc) -> MaterialKind {
        let span = props.object.span;
        let interface = match self.metal(props) {
            Metal::Named(eta, k) => ConductorDesc::Ior {
                eta: Textured::Value(eta),
                k: Textured::Value(k),
            },
            Metal::Typed(eta, k) => ConductorDesc::Ior {
                eta: self.color(Some(eta), 0.0, span, Use::Unbounded),
                k: self.color(Some(k), 1.0, span, Use::Unbounded),
            },
            // An index of 0 + i reflects everything.
            Metal::Mirror => ConductorDesc::Ior {
                eta: constant(0.0, span),
                k: constant(1.0, span),
            },
        };
        MaterialKind::Conductor {
            interface,
            roughness,
            multiple_scattering: false,
        }
    }

    fn dielectric(&mut self, props: &mut Props<'g>, roughness: RoughnessDesc) -> MaterialKind {
        let eta = self.relative_ior(props, "bk7");
        MaterialKind::Dielectric {
            eta: number(eta, props.object.span),
            roughness,
            multiple_scattering: false,
        }
    }

    fn plastic(&mut self, props: &mut Props<'g>, roughness: Option<RoughnessDesc>) -> MaterialKind {
        let span = props.object.span;
        let eta = self.relative_ior(props, "polypropylene");
        let (diffuse, specular) = (props.take("diffuse_reflectance"), props.take("specular_reflectance"));
        MaterialKind::Plastic(PlasticDesc {
            diffuse_reflectance: self.color(diffuse, 0.5, span, Use::Albedo),
            specular_reflectance: self.color(specular, 1.0, span, Use::Albedo),
            eta: eta as f32,
            nonlinear: props.boolean("nonlinear", false),
            roughness: roughness.unwrap_or_else(smooth),
        })
    }

    fn roughness(&mut self, props: &mut Props<'g>) -> RoughnessDesc {
        let distribution = match props.choice("distribution", &["beckmann", "ggx"]) {
            "ggx" => DistributionDesc::Ggx,
            _ => DistributionDesc::Beckmann,
        };
        // How directions are drawn; the mean is the same.
        props.ignore(&["sample_visible"]);
        let both = props.take("alpha");
        let [u, v] = ["alpha_u", "alpha_v"].map(|name| props.take(name));
        if both.is_some() && (u.is_some() || v.is_some()) {
            props.error(
                props.span_of("alpha"),
                "`alpha` and `alpha_u` or `alpha_v` exclude each other",
            );
        }
        if u.is_some() != v.is_some() {
            let message = "`alpha_u` and `alpha_v` are given both or not at all";
            props.error(props.object.span, message);
        }
        RoughnessDesc {
            u: self.number(both.or(u), 0.1),
            v: self.number(both.or(v), 0.1),
            remap: false,
            distribution,
            separable_masking: true,
        }
    }

    fn principled(&mut self, props: &mut Props<'g>) -> (MaterialKind, bool) {
        let span = props.object.span;
        let base = props.take("base_color");
        let mut fraction = |name: &'static str, default: f32| {
            let property = props.take(name);
            self.fraction(property, default)
        };
        let mut desc = PrincipledDesc {
            base_color: constant(0.5, span),
            roughness: fraction("roughness", 0.5),
            anisotropic: fraction("anisotropic", 0.0),
            metallic: fraction("metallic", 0.0),
            spec_trans: fraction("spec_trans", 0.0),
            eta: 1.5,
            spec_tint: fraction("spec_tint", 0.0),
            sheen: fraction("sheen", 0.0),
            sheen_tint: fraction("sheen_tint", 0.0),
            clearcoat: fraction("clearcoat", 0.0),
            clearcoat_gloss: fraction("clearcoat_gloss", 0.0),
            flatness: fraction("flatness", 0.0),
            as_in_mitsuba: true,
        };
        desc.base_color = self.color(base, 0.5, span, Use::Albedo);
        if props.has("specular") && props.has("eta") {
            props.error(props.span_of("specular"), "`specular` and `eta` exclude each other");
        }
        let specular = props.float_in("specular", 0.5, "a number in [0, 1]", |v| (0.0..=1.0).contains(&v));
        let by_specular = 2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0;
        let eta = props.float_in("eta", by_specular, "1 or more", |v| v >= 1.0);
        desc.eta = eta.max(1.0) as f32;
        props.ignore(&[
            "diffuse_reflectance_sampling_rate",
            "main_specular_sampling_rate",
            "clearcoat_sampling_rate",
        ]);
        let transmits = desc.spec_trans != Textured::Value(0.0);
        (MaterialKind::Principled(desc), !transmits)
    }
}

fn smooth() -> RoughnessDesc {
    RoughnessDesc {
        u: Textured::Value(0.0),
        v: Textured::Value(0.0),
        remap: false,
        distribution: DistributionDesc::Beckmann,
        separable_masking: true,
    }
}

fn number(value: f64, span: Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Constant(value as f32),
        span,
    }
}
