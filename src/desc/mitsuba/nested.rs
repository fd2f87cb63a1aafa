//! Bsdfs around other bsdfs: sides, masks, blends, bump and normal maps.

use super::bsdf::Scattering;
use super::graph::Property;
use super::loader::Loader;
use super::plugins::Class;
use super::props::Props;
use super::texture;
use crate::desc::{MaterialDesc, MaterialId, MaterialKind, ReliefDesc, Textured};

impl<'g> Loader<'g> {
    pub fn two_sided(&mut self, props: &mut Props<'g>) -> Option<Scattering> {
        let children = self.children(props, Class::Bsdf);
        let span = props.object.span;
        if children.is_empty() || children.len() > 2 {
            props.error(span, "`twosided` takes one bsdf or two");
            return None;
        }
        let mut sides = Vec::with_capacity(2);
        for (index, object) in children {
            let scattering = self.scattering(index)?;
            if !scattering.one_sided {
                let message = format!(
                    "`{}` cannot be inside `twosided`: it transmits, or has two sides itself",
                    object.plugin
                );
                props.error(object.span, message);
                return None;
            }
            sides.push(scattering);
        }
        let Some(back) = sides.get(1) else {
            return sides.pop().map(|front| Scattering {
                one_sided: false,
                ..front
            });
        };
        let kind = MaterialKind::Sided {
            front: Some(sides[0].material),
            back: Some(back.material),
        };
        Some(Scattering {
            material: self.add_material(kind, span),
            one_sided: false,
            alpha: Textured::Value(1.0),
        })
    }

    pub fn mask(&mut self, props: &mut Props<'g>) -> Option<Scattering> {
        let inner = self.inner(props);
        let opacity = props.take("opacity");
        let alpha = self.fraction(opacity, 0.5);
        let inner = inner?;
        let span = props.object.span;
        let alpha = self.product(alpha, inner.alpha.clone(), span);
        // What is not masked has its sides here: a `mask` cannot be inside a `twosided`.
        Some(Scattering {
            material: self.closed(&inner),
            one_sided: false,
            alpha,
        })
    }

    pub fn blend(&mut self, props: &mut Props<'g>) -> Option<Scattering> {
        let children = self.children(props, Class::Bsdf);
        let weight = props.take("weight");
        let span = props.object.span;
        if weight.is_none() {
            props.error(span, "`blendbsdf` needs a `weight`");
        }
        let amount = self.fraction(weight, 0.5);
        let [first, second] = children[..] else {
            props.error(span, "`blendbsdf` takes two bsdfs");
            return None;
        };
        let [no_first, no_second] = [first, second].map(|(_, object)| object.plugin == "null");
        if no_first || no_second {
            let there = if no_first { second } else { first };
            let inner = self.scattering(there.0)?;
            let share = if no_first { amount } else { self.rest(amount, span) };
            return Some(Scattering {
                material: self.closed(&inner),
                one_sided: false,
                alpha: self.product(share, inner.alpha.clone(), span),
            });
        }
        let parts = [self.scattering(first.0)?, self.scattering(second.0)?];
        if parts.iter().any(|part| part.alpha != Textured::Value(1.0)) {
            props.unsupported(span, "a `mask` inside a `blendbsdf` is not supported", "it is ignored");
        }
        let one_sided = parts.iter().all(|part| part.one_sided);
        let materials = if one_sided {
            parts.map(|part| part.material)
        } else {
            parts.map(|part| self.closed(&part))
        };
        Some(Scattering {
            material: self.add_material(MaterialKind::Mix { materials, amount }, span),
            one_sided,
            alpha: Textured::Value(1.0),
        })
    }

    pub fn relief(&mut self, props: &mut Props<'g>) -> Option<Scattering> {
        let inner = self.inner(props);
        let span = props.object.span;
        let relief = if props.object.plugin == "normalmap" {
            let map = props.take("normalmap");
            if map.is_none() {
                props.error(span, "`normalmap` needs a texture `normalmap`");
            }
            self.normals(props, map)
        } else {
            let scale = props.float("scale").unwrap_or(1.0);
            let texture = self.children(props, Class::Texture);
            if texture.len() != 1 {
                props.error(span, "`bumpmap` takes one texture");
            }
            let (index, object) = *texture.first()?;
            self.texture(index, object, false)
                .map(|id| ReliefDesc::Displacement(self.scaled(id, scale as f32, span)))
        };
        let (inner, relief) = (inner?, relief?);
        let desc = self.materials[inner.material.0 as usize].clone();
        if desc.relief.is_some() {
            props.unsupported(
                span,
                "a bump or normal map inside another is not supported",
                "the outer one counts",
            );
        }
        self.materials.push(MaterialDesc {
            relief: Some(relief),
            ..desc
        });
        Some(Scattering {
            material: MaterialId(self.materials.len() as u32 - 1),
            ..inner
        })
    }

    fn normals(&mut self, props: &mut Props<'g>, map: Option<&'g Property>) -> Option<ReliefDesc> {
        let map = map?;
        let Some((_, object)) = self.texture_of(map).filter(|(_, object)| object.plugin == "bitmap") else {
            props.error(map.span, "the `normalmap` of a `normalmap` must be a `bitmap`");
            return None;
        };
        let image = self.bitmap(object)?;
        if !texture::is_plain(&image) {
            props.unsupported(
                map.span,
                "`to_uv` and `wrap_mode` of a normal map are not supported",
                "they are ignored",
            );
        }
        Some(ReliefDesc::Normals(image.image))
    }

    /// The one bsdf inside another.
    fn inner(&mut self, props: &mut Props<'g>) -> Option<Scattering> {
        match self.child(props, Class::Bsdf) {
            Some((index, _)) => self.scattering(index),
            None => {
                let message = format!("`{}` takes a bsdf", props.object.plugin);
                props.error(props.object.span, message);
                None
            }
        }
    }
}
