//! Materials, each by a name.

use std::collections::HashSet;

use super::Writer;
use super::entity::Entity;
use crate::desc::{
    CoatDesc, ConductorDesc, DistributionDesc, HairColorDesc, HairDesc, MaterialDesc, MaterialKind, PlasticDesc,
    PrincipledDesc, ReliefDesc, RoughnessDesc, SceneDesc, SpectrumDesc, SpectrumValue, Textured,
};
use crate::error::Result;

/// What each material is called, by its name if it has one; the first, pbrt's default, by none.
pub(super) fn names(desc: &SceneDesc) -> Vec<String> {
    let mut taken: HashSet<String> = desc
        .materials
        .iter()
        .filter_map(|material| material.name.clone())
        .collect();
    let mut number = 0;
    desc.materials
        .iter()
        .enumerate()
        .map(|(index, material)| {
            if index == 0 {
                return String::new();
            }
            material.name.clone().unwrap_or_else(|| {
                loop {
                    number += 1;
                    let name = format!("material-{number}");
                    if taken.insert(name.clone()) {
                        return name;
                    }
                }
            })
        })
        .collect()
}

impl Writer<'_> {
    pub(super) fn materials(&mut self) -> Result<()> {
        // The first is there without being defined.
        for (material, name) in self.desc.materials.iter().zip(self.material_names.clone()).skip(1) {
            let mut entity = Entity::new("MakeNamedMaterial", &name);
            self.material_kind(&mut entity, &material.kind)?;
            self.relief(&mut entity, material)?;
            self.put(entity)?;
        }
        Ok(())
    }

    fn relief(&mut self, entity: &mut Entity, material: &MaterialDesc) -> Result<()> {
        match &material.relief {
            None => {}
            Some(ReliefDesc::Displacement(id)) => {
                entity.float_textured("displacement", &Textured::Texture(*id), &self.texture_names);
            }
            Some(ReliefDesc::Normals(id)) => {
                let file = self.parts.image_file(&self.desc.images[id.0 as usize])?;
                entity.string("normalmap", &file);
            }
        }
        Ok(())
    }

    fn material_kind(&mut self, e: &mut Entity, kind: &MaterialKind) -> Result<()> {
        let name = match kind {
            MaterialKind::Diffuse { .. } => "diffuse",
            MaterialKind::DiffuseTransmission { .. } => "diffusetransmission",
            MaterialKind::Conductor { .. } => "conductor",
            MaterialKind::Dielectric { .. } => "dielectric",
            MaterialKind::ThinDielectric { .. } => "thindielectric",
            MaterialKind::CoatedDiffuse { .. } => "coateddiffuse",
            MaterialKind::CoatedConductor { .. } => "coatedconductor",
            MaterialKind::Hair(_) => "hair",
            MaterialKind::Interface => "interface",
            MaterialKind::Mix { .. } => "mix",
            MaterialKind::Principled(_) => "principled",
            MaterialKind::Measured(_) => "measured",
            MaterialKind::Sided { .. } => "sided",
            MaterialKind::Tinted { .. } => "tinted",
            MaterialKind::Plastic(_) => "plastic",
        };
        e.string("type", name);
        let names = &self.texture_names.clone();
        match kind {
            MaterialKind::Diffuse { reflectance, roughness } => {
                e.spectrum_textured("reflectance", reflectance, names);
                if *roughness != Textured::Value(0.0) {
                    e.float_textured("roughness", roughness, names);
                    self.note("Material \"diffuse\" \"float roughness\"");
                }
            }
            MaterialKind::DiffuseTransmission {
                reflectance,
                transmittance,
                scale,
            } => {
                e.spectrum_textured("reflectance", reflectance, names)
                    .spectrum_textured("transmittance", transmittance, names)
                    .single("scale", *scale);
            }
            MaterialKind::Conductor {
                interface,
                roughness,
                multiple_scattering,
            } => {
                put_metal(e, interface, ["eta", "k"], names);
                self.roughness(e, roughness, "", true);
                self.multiple_scattering(e, *multiple_scattering);
            }
            MaterialKind::Dielectric {
                eta,
                roughness,
                multiple_scattering,
            } => {
                put_index(e, "eta", eta);
                self.roughness(e, roughness, "", true);
                self.multiple_scattering(e, *multiple_scattering);
            }
            MaterialKind::ThinDielectric { eta } => put_index(e, "eta", eta),
            MaterialKind::CoatedDiffuse { reflectance, coat } => {
                e.spectrum_textured("reflectance", reflectance, names);
                put_index(e, "eta", &coat.eta);
                self.roughness(e, &coat.roughness, "", true);
                put_coat(e, coat, names);
            }
            MaterialKind::CoatedConductor {
                interface,
                roughness,
                coat,
            } => {
                put_metal(e, interface, ["conductor.eta", "conductor.k"], names);
                self.roughness(e, roughness, "conductor.", true);
                put_index(e, "interface.eta", &coat.eta);
                // Remapping and distribution are those of both.
                self.roughness(e, &coat.roughness, "interface.", false);
                put_coat(e, coat, names);
            }
            MaterialKind::Hair(hair) => put_hair(e, hair, names),
            MaterialKind::Interface => {}
            MaterialKind::Mix { materials, amount } => {
                let [a, b] = materials.map(|id| self.material_names[id.0 as usize].clone());
                e.strings("materials", [&a, &b]).float_textured("amount", amount, names);
            }
            MaterialKind::Principled(principled) => {
                put_principled(e, principled, names);
                self.note("Material \"principled\"");
            }
            MaterialKind::Sided { front, back } => {
                for (name, side) in [("front", front), ("back", back)] {
                    if let Some(id) = side {
                        e.string(name, &self.material_names[id.0 as usize]);
                    }
                }
                self.note("Material \"sided\"");
            }
            MaterialKind::Tinted {
                material,
                reflectance,
                transmittance,
            } => {
                e.string("material", &self.material_names[material.0 as usize])
                    .spectrum_textured("reflectance", reflectance, names)
                    .spectrum_textured("transmittance", transmittance, names);
                self.note("Material \"tinted\"");
            }
            MaterialKind::Plastic(plastic) => {
                put_plastic(e, plastic, names);
                self.roughness(e, &plastic.roughness, "", true);
                self.note("Material \"plastic\"");
            }
            MaterialKind::Measured(measured) => {
                let file = self.parts.file(&measured.path)?;
                e.string("filename", &file);
            }
        }
        Ok(())
    }

    fn multiple_scattering(&mut self, e: &mut Entity, multiple_scattering: bool) {
        if multiple_scattering {
            e.boolean("multiplescattering", true);
            self.note("Material \"bool multiplescattering\"");
        }
    }

    fn roughness(&mut self, e: &mut Entity, roughness: &RoughnessDesc, of: &str, is_first: bool) {
        let names = &self.texture_names;
        e.float_textured(&format!("{of}uroughness"), &roughness.u, names)
            .float_textured(&format!("{of}vroughness"), &roughness.v, names);
        if is_first {
            e.boolean("remaproughness", roughness.remap);
            if roughness.distribution == DistributionDesc::Beckmann {
                e.string("distribution", "beckmann");
                self.note("Material \"string distribution\"");
            }
            if roughness.separable_masking {
                e.string("masking", "separable");
                self.note("Material \"string masking\"");
            }
        }
    }
}

fn put_metal(e: &mut Entity, interface: &ConductorDesc, [eta_name, k_name]: [&str; 2], names: &[String]) {
    match interface {
        ConductorDesc::Ior { eta, k } => {
            e.spectrum_textured(eta_name, eta, names)
                .spectrum_textured(k_name, k, names);
        }
        ConductorDesc::Reflectance(reflectance) => {
            e.spectrum_textured("reflectance", reflectance, names);
        }
    }
}

/// An index of refraction, which pbrt writes as a plain number if it is one.
fn put_index(e: &mut Entity, name: &str, eta: &SpectrumDesc) {
    match eta.value {
        SpectrumValue::Constant(eta) => e.single(name, eta),
        _ => e.spectrum(name, eta),
    };
}

fn put_coat(e: &mut Entity, coat: &CoatDesc, names: &[String]) {
    e.float_textured("thickness", &coat.thickness, names)
        .spectrum_textured("albedo", &coat.albedo, names)
        .float_textured("g", &coat.g, names)
        .integer("maxdepth", coat.max_depth.into())
        .integer("nsamples", coat.samples.into());
}

fn put_hair(e: &mut Entity, hair: &HairDesc, names: &[String]) {
    match &hair.color {
        HairColorDesc::Absorption(sigma) => e.spectrum_textured("sigma_a", sigma, names),
        HairColorDesc::Reflectance(color) => e.spectrum_textured("reflectance", color, names),
        HairColorDesc::Pigments { eumelanin, pheomelanin } => e
            .float_textured("eumelanin", eumelanin, names)
            .float_textured("pheomelanin", pheomelanin, names),
    };
    e.single("eta", hair.eta)
        .float_textured("beta_m", &hair.beta_m, names)
        .float_textured("beta_n", &hair.beta_n, names)
        .float_textured("alpha", &hair.alpha, names);
}

fn put_plastic(e: &mut Entity, plastic: &PlasticDesc, names: &[String]) {
    e.spectrum_textured("reflectance", &plastic.diffuse_reflectance, names)
        .spectrum_textured("specularreflectance", &plastic.specular_reflectance, names)
        .single("eta", plastic.eta)
        .boolean("nonlinear", plastic.nonlinear);
}

fn put_principled(e: &mut Entity, principled: &PrincipledDesc, names: &[String]) {
    e.spectrum_textured("base_color", &principled.base_color, names)
        .single("eta", principled.eta);
    for (name, value) in [
        ("roughness", &principled.roughness),
        ("anisotropic", &principled.anisotropic),
        ("metallic", &principled.metallic),
        ("spec_trans", &principled.spec_trans),
        ("spec_tint", &principled.spec_tint),
        ("sheen", &principled.sheen),
        ("sheen_tint", &principled.sheen_tint),
        ("clearcoat", &principled.clearcoat),
        ("clearcoat_gloss", &principled.clearcoat_gloss),
        ("flatness", &principled.flatness),
    ] {
        e.float_textured(name, value, names);
    }
    if principled.as_in_mitsuba {
        e.boolean("additive", true);
    }
}
