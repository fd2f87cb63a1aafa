//! Materials as described to materials as evaluated.

use std::sync::Arc;

use super::textures::{SpectrumUse, TextureCompiler};
use crate::desc::{
    CoatDesc, ConductorDesc, HairColorDesc, HairDesc, MaterialDesc, MaterialId, MaterialKind, PlasticDesc,
    PrincipledDesc,
};
use crate::material::{
    Coat, ConductorIor, HairColor, HairMaterial, Material, MeasuredTables, MixMaterial, PlasticMaterial, PlasticTables,
    PrincipledMaterial, PrincipledTables, Relief, Roughness, TintedMaterial,
};

/// All materials of a scene, by their ids.
pub(super) fn compile_materials(descs: &[MaterialDesc], textures: &mut TextureCompiler<'_>) -> Vec<Material> {
    let mut compiler = MaterialCompiler {
        descs,
        textures,
        done: vec![None; descs.len()],
    };
    (0..descs.len())
        .map(|index| compiler.material(MaterialId(index as u32)))
        .collect()
}

/// Makes each material once.
struct MaterialCompiler<'a, 'b> {
    descs: &'a [MaterialDesc],
    textures: &'a mut TextureCompiler<'b>,
    done: Vec<Option<Material>>,
}

impl MaterialCompiler<'_, '_> {
    fn material(&mut self, id: MaterialId) -> Material {
        let index = id.0 as usize;
        if let Some(material) = &self.done[index] {
            return material.clone();
        }
        let desc = &self.descs[index];
        let material = self.compile(&desc.kind);
        let map = desc.relief.as_ref().and_then(|relief| self.textures.relief(relief));
        let material = match map {
            Some(map) => Material::Relief(Arc::new(Relief { map, material })),
            None => material,
        };
        self.done[index] = Some(material.clone());
        material
    }

    // Mixes are nested to a limited depth and none contains itself: the reader sees to it.
    fn compile(&mut self, kind: &MaterialKind) -> Material {
        match kind {
            MaterialKind::Diffuse { reflectance, roughness } => Material::Diffuse {
                reflectance: self.textures.spectrum(reflectance, SpectrumUse::Albedo),
                roughness: self.textures.float(roughness),
            },
            MaterialKind::DiffuseTransmission {
                reflectance,
                transmittance,
                scale,
            } => Material::DiffuseTransmission {
                reflectance: self.textures.spectrum(reflectance, SpectrumUse::Albedo),
                transmittance: self.textures.spectrum(transmittance, SpectrumUse::Albedo),
                scale: *scale,
            },
            MaterialKind::Conductor {
                interface,
                roughness,
                multiple_scattering,
            } => Material::Conductor {
                ior: conductor(interface, self.textures),
                roughness: self.textures.roughness(roughness),
                multiple_scattering: *multiple_scattering,
            },
            MaterialKind::Dielectric {
                eta,
                roughness,
                multiple_scattering,
            } => Material::Dielectric {
                eta: self.textures.spectra.glass_index(eta),
                roughness: self.textures.roughness(roughness),
                multiple_scattering: *multiple_scattering,
            },
            MaterialKind::ThinDielectric { eta } => Material::ThinDielectric {
                eta: self.textures.spectra.glass_index(eta),
            },
            MaterialKind::CoatedDiffuse { reflectance, coat } => Material::CoatedDiffuse {
                reflectance: self.textures.spectrum(reflectance, SpectrumUse::Albedo),
                coat: Arc::new(coating(coat, self.textures)),
            },
            MaterialKind::CoatedConductor {
                interface,
                roughness,
                coat,
            } => Material::CoatedConductor {
                ior: conductor(interface, self.textures),
                roughness: self.textures.roughness(roughness),
                coat: Arc::new(coating(coat, self.textures)),
            },
            MaterialKind::Principled(desc) => Material::Principled(Arc::new(principled(desc, self.textures))),
            MaterialKind::Measured(desc) => {
                Material::Measured(Arc::new(MeasuredTables::new(desc, self.textures.spectra.mode)))
            }
            MaterialKind::Sided { front, back } => {
                Material::Sided(Arc::new([*front, *back].map(|side| side.map(|id| self.material(id)))))
            }
            MaterialKind::Tinted {
                material,
                reflectance,
                transmittance,
            } => Material::Tinted(Arc::new(TintedMaterial {
                material: self.material(*material),
                reflectance: self.textures.spectrum(reflectance, SpectrumUse::Albedo),
                transmittance: self.textures.spectrum(transmittance, SpectrumUse::Albedo),
            })),
            MaterialKind::Plastic(desc) => Material::Plastic(Arc::new(plastic(desc, self.textures))),
            MaterialKind::Hair(desc) => Material::Hair(Arc::new(hair(desc, self.textures))),
            MaterialKind::Interface => Material::Interface,
            MaterialKind::Mix { materials, amount } => Material::Mix(Arc::new(MixMaterial {
                materials: materials.map(|id| self.material(id)),
                amount: self.textures.float(amount),
            })),
        }
    }
}

fn conductor(interface: &ConductorDesc, textures: &mut TextureCompiler<'_>) -> ConductorIor {
    match interface {
        ConductorDesc::Ior { eta, k } => ConductorIor::Measured {
            eta: textures.spectrum(eta, SpectrumUse::Unbounded),
            k: textures.spectrum(k, SpectrumUse::Unbounded),
        },
        ConductorDesc::Reflectance(r) => ConductorIor::Reflectance(textures.spectrum(r, SpectrumUse::Albedo)),
    }
}

fn coating(desc: &CoatDesc, textures: &mut TextureCompiler<'_>) -> Coat {
    Coat {
        eta: textures.spectra.glass_index(&desc.eta),
        roughness: textures.roughness(&desc.roughness),
        thickness: textures.float(&desc.thickness),
        albedo: textures.spectrum(&desc.albedo, SpectrumUse::Albedo),
        g: textures.float(&desc.g),
        max_depth: desc.max_depth,
        samples: desc.samples,
    }
}

fn plastic(desc: &PlasticDesc, textures: &mut TextureCompiler<'_>) -> PlasticMaterial {
    let facets = match textures.roughness(&desc.roughness) {
        Roughness::Constant(facets) => facets,
        // The reader sees to it that there is none.
        Roughness::Textured(_) => None,
    };
    PlasticMaterial {
        diffuse: textures.spectrum(&desc.diffuse_reflectance, SpectrumUse::Albedo),
        specular: textures.spectrum(&desc.specular_reflectance, SpectrumUse::Albedo),
        nonlinear: desc.nonlinear,
        tables: PlasticTables::new(desc.eta, facets),
    }
}

fn hair(desc: &HairDesc, textures: &mut TextureCompiler<'_>) -> HairMaterial {
    // What a unit of the brown and of the red pigment absorbs (d'Eon et al. 2011, as in pbrt-v4).
    const PIGMENTS: [[f32; 3]; 2] = [[0.419, 0.697, 1.37], [0.187, 0.4, 1.05]];
    HairMaterial {
        color: match &desc.color {
            HairColorDesc::Absorption(sigma) => HairColor::Absorption(textures.spectrum(sigma, SpectrumUse::Unbounded)),
            HairColorDesc::Reflectance(color) => HairColor::Reflectance(textures.spectrum(color, SpectrumUse::Albedo)),
            HairColorDesc::Pigments { eumelanin, pheomelanin } => {
                let [brown, red] = PIGMENTS.map(|rgb| textures.spectra.absorption_of_rgb(rgb));
                HairColor::Pigments([(textures.float(eumelanin), brown), (textures.float(pheomelanin), red)])
            }
        },
        eta: desc.eta,
        beta_m: textures.float(&desc.beta_m),
        beta_n: textures.float(&desc.beta_n),
        alpha: textures.float(&desc.alpha),
    }
}

fn principled(desc: &PrincipledDesc, textures: &mut TextureCompiler<'_>) -> PrincipledMaterial {
    PrincipledMaterial {
        base: textures.spectrum(&desc.base_color, SpectrumUse::Albedo),
        roughness: textures.float(&desc.roughness),
        anisotropic: textures.float(&desc.anisotropic),
        metallic: textures.float(&desc.metallic),
        spec_trans: textures.float(&desc.spec_trans),
        eta: desc.eta,
        spec_tint: textures.float(&desc.spec_tint),
        sheen: textures.float(&desc.sheen),
        sheen_tint: textures.float(&desc.sheen_tint),
        clearcoat: textures.float(&desc.clearcoat),
        clearcoat_gloss: textures.float(&desc.clearcoat_gloss),
        flatness: textures.float(&desc.flatness),
        as_in_mitsuba: desc.as_in_mitsuba,
        tables: PrincipledTables::new(desc.eta),
    }
}
