//! Textures.

use super::Writer;
use super::entity::{Entity, transform};
use crate::desc::{
    ClassedTexture, ImageFilterDesc, ImageMapDesc, MappingDesc, OctavesDesc, SceneDesc, SpectrumDesc, TextureDesc,
    TextureKind, Textured, WrapDesc,
};
use crate::error::Result;
use glam::DAffine3;

/// What each texture is called.
pub(super) fn names(desc: &SceneDesc) -> Vec<String> {
    desc.textures.iter().map(|texture| texture.name.clone()).collect()
}

/// How the values of a class of textures are written.
trait Value: Sized {
    fn value(entity: &mut Entity, name: &str, value: &Self);
    fn textured(entity: &mut Entity, name: &str, value: &Textured<Self>, names: &[String]);
}

impl Value for f32 {
    fn value(entity: &mut Entity, name: &str, value: &Self) {
        entity.single(name, *value);
    }

    fn textured(entity: &mut Entity, name: &str, value: &Textured<Self>, names: &[String]) {
        entity.float_textured(name, value, names);
    }
}

impl Value for SpectrumDesc {
    fn value(entity: &mut Entity, name: &str, value: &Self) {
        entity.spectrum(name, value);
    }

    fn textured(entity: &mut Entity, name: &str, value: &Textured<Self>, names: &[String]) {
        entity.spectrum_textured(name, value, names);
    }
}

impl Writer<'_> {
    pub(super) fn textures(&mut self) -> Result<()> {
        for texture in &self.desc.textures {
            if texture.world_from_texture == DAffine3::IDENTITY {
                self.texture(texture)?;
            } else {
                self.block(|writer| {
                    writer.line(&transform(&texture.world_from_texture));
                    writer.texture(texture)
                })?;
            }
        }
        Ok(())
    }

    fn texture(&mut self, texture: &TextureDesc) -> Result<()> {
        let entity = match &texture.kind {
            ClassedTexture::Float(kind) => self.texture_kind(texture, "float", kind)?,
            ClassedTexture::Spectrum(kind) => self.texture_kind(texture, "spectrum", kind)?,
        };
        self.put(entity)
    }

    fn texture_kind<V: Value>(&mut self, texture: &TextureDesc, class: &str, kind: &TextureKind<V>) -> Result<Entity> {
        let name = match kind {
            TextureKind::Constant(_) => "constant",
            TextureKind::Scale { .. } => "scale",
            TextureKind::Mix { .. } => "mix",
            TextureKind::DirectionMix { .. } => "directionmix",
            TextureKind::Checkerboard2 { .. } | TextureKind::Checkerboard3 { .. } => "checkerboard",
            TextureKind::Dots { .. } => "dots",
            TextureKind::Bilerp { .. } => "bilerp",
            TextureKind::Image(_) => "imagemap",
            TextureKind::MeshAttribute { .. } => {
                self.note("Texture \"meshattribute\"");
                "meshattribute"
            }
            TextureKind::Fbm(_) => "fbm",
            TextureKind::Wrinkled(_) => "wrinkled",
            TextureKind::Windy => "windy",
            TextureKind::Marble { .. } => "marble",
        };
        if matches!(kind.mapping(), Some(MappingDesc::Affine { .. })) {
            self.note("Texture \"string mapping\" \"affine\"");
        }
        let mut entity = Entity::texture(&texture.name, class, name);
        let e = &mut entity;
        let names = &self.texture_names;
        let two = |e: &mut Entity, textures: &[Textured<V>; 2]| {
            V::textured(e, "tex1", &textures[0], names);
            V::textured(e, "tex2", &textures[1], names);
        };
        match kind {
            TextureKind::Constant(value) => V::value(e, "value", value),
            TextureKind::Scale { tex, scale } => {
                V::textured(e, "tex", tex, names);
                e.float_textured("scale", scale, names);
            }
            TextureKind::Mix { textures, amount } => {
                two(e, textures);
                e.float_textured("amount", amount, names);
            }
            TextureKind::DirectionMix { textures, direction } => {
                two(e, textures);
                e.point("vector3", "dir", *direction);
            }
            TextureKind::Checkerboard2 { textures, mapping } => {
                two(e, textures);
                put_mapping(e, mapping);
            }
            TextureKind::Checkerboard3 { textures } => {
                two(e, textures);
                e.integer("dimension", 3);
            }
            TextureKind::Dots {
                inside,
                outside,
                mapping,
            } => {
                V::textured(e, "inside", inside, names);
                V::textured(e, "outside", outside, names);
                put_mapping(e, mapping);
            }
            TextureKind::Bilerp { corners, mapping } => {
                for (name, corner) in ["v00", "v01", "v10", "v11"].into_iter().zip(corners) {
                    V::value(e, name, corner);
                }
                put_mapping(e, mapping);
            }
            TextureKind::Image(map) => self.image_map(e, map)?,
            TextureKind::Fbm(octaves) | TextureKind::Wrinkled(octaves) => put_octaves(e, octaves),
            TextureKind::Windy => {}
            TextureKind::MeshAttribute { name, scale } => {
                e.string("name", name).single("scale", *scale);
            }
            TextureKind::Marble {
                octaves,
                scale,
                variation,
            } => {
                put_octaves(e, octaves);
                e.single("scale", *scale).single("variation", *variation);
            }
        }
        Ok(entity)
    }

    fn image_map(&mut self, entity: &mut Entity, map: &ImageMapDesc) -> Result<()> {
        let image = &self.desc.images[map.image.0 as usize];
        let file = self.parts.image_file(image)?;
        entity
            .string("filename", &file)
            .string("encoding", &image.encoding.to_string())
            .single("scale", map.scale)
            .boolean("invert", map.invert);
        let wrap = match map.wrap {
            WrapDesc::Repeat => "repeat",
            WrapDesc::Black => "black",
            WrapDesc::Clamp => "clamp",
            WrapDesc::OctahedralSphere => "octahedralsphere",
            WrapDesc::Mirror => {
                self.note("Texture \"string wrap\" \"mirror\"");
                "mirror"
            }
        };
        entity.string("wrap", wrap);
        match map.filter {
            ImageFilterDesc::Point => entity.string("filter", "point"),
            ImageFilterDesc::Bilinear => entity.string("filter", "bilinear"),
            ImageFilterDesc::Trilinear => entity.string("filter", "trilinear"),
            ImageFilterDesc::Ewa { max_anisotropy } => {
                entity.string("filter", "EWA").single("maxanisotropy", max_anisotropy)
            }
        };
        put_mapping(entity, &map.mapping);
        Ok(())
    }
}

fn put_mapping(entity: &mut Entity, mapping: &MappingDesc) {
    match mapping {
        MappingDesc::Uv { scale, delta } => {
            entity
                .string("mapping", "uv")
                .single("uscale", scale.x)
                .single("vscale", scale.y)
                .single("udelta", delta.x)
                .single("vdelta", delta.y);
        }
        MappingDesc::Affine { matrix, delta } => {
            let row = |i: usize| matrix.row(i).extend(0.0).to_array().into_iter();
            entity
                .string("mapping", "affine")
                .singles("vector3", "v1", row(0))
                .singles("vector3", "v2", row(1))
                .single("udelta", delta.x)
                .single("vdelta", delta.y);
        }
        MappingDesc::Spherical => {
            entity.string("mapping", "spherical");
        }
        MappingDesc::Cylindrical => {
            entity.string("mapping", "cylindrical");
        }
        MappingDesc::Planar { vectors, delta } => {
            entity
                .string("mapping", "planar")
                .singles("vector3", "v1", vectors[0].to_array().into_iter())
                .singles("vector3", "v2", vectors[1].to_array().into_iter())
                .single("udelta", delta.x)
                .single("vdelta", delta.y);
        }
    }
}

fn put_octaves(entity: &mut Entity, octaves: &OctavesDesc) {
    entity
        .integer("octaves", octaves.octaves.into())
        .single("roughness", octaves.roughness);
}
