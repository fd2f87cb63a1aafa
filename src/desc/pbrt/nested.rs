//! Materials made of other materials: which can be made of which.

use super::report::Report;
use crate::desc::{MaterialDesc, MaterialId, MaterialKind, Textured};

/// How many materials may contain one another in a row.
const DEEPEST: usize = 64;

/// Complains about materials made of what they cannot be made of, or of themselves.
pub(super) fn check(materials: &[MaterialDesc], report: &mut Report) {
    if let Some(material) = endless(materials) {
        let message = format!("this material contains itself, or more than {DEEPEST} contain one another in a row");
        report.error(material.span, message);
        return;
    }
    let transmits = transmitting(materials);
    for material in materials {
        let mut parts = material.kind.parts();
        let kind = |id: MaterialId| &materials[id.0 as usize].kind;
        let problem = match material.kind {
            MaterialKind::Mix { .. } if parts.any(|id| matches!(kind(id), MaterialKind::Interface)) => {
                "a mix cannot contain the material `interface`, which is no surface"
            }
            MaterialKind::Sided { .. } if parts.any(|id| transmits[id.0 as usize]) => {
                "a `sided` material cannot contain one that transmits light"
            }
            // A name that is not defined, which is said elsewhere, has got a material without one.
            MaterialKind::Tinted { .. }
                if parts.any(|id| materials[id.0 as usize].name.is_some() && !can_be_tinted(kind(id))) =>
            {
                "only `conductor`, `dielectric` and `thindielectric` can be `tinted`"
            }
            _ => continue,
        };
        report.error(material.span, problem);
    }
}

/// The first material that contains itself, or too many others in a row.
fn endless(materials: &[MaterialDesc]) -> Option<&MaterialDesc> {
    // Each round settles the materials made of what is settled; what a cycle needs never is.
    let mut settled = vec![false; materials.len()];
    for _ in 0..=DEEPEST {
        let is_settled = |material: &MaterialDesc| material.kind.parts().all(|id| settled[id.0 as usize]);
        let now: Vec<bool> = materials.iter().map(is_settled).collect();
        if now == settled {
            break;
        }
        settled = now;
    }
    settled.iter().position(|settled| !settled).map(|i| &materials[i])
}

/// Of each material whether light may come through it. None of them contains itself.
fn transmitting(materials: &[MaterialDesc]) -> Vec<bool> {
    let mut known: Vec<bool> = materials.iter().map(|material| transmits(&material.kind)).collect();
    loop {
        let through = |material: &MaterialDesc| material.kind.parts().any(|id| known[id.0 as usize]);
        let now: Vec<bool> = materials
            .iter()
            .zip(&known)
            .map(|(material, &known)| known || through(material))
            .collect();
        if now == known {
            return known;
        }
        known = now;
    }
}

/// Whether a kind of material lets light through by itself.
fn transmits(kind: &MaterialKind) -> bool {
    match kind {
        MaterialKind::DiffuseTransmission { .. }
        | MaterialKind::Dielectric { .. }
        | MaterialKind::ThinDielectric { .. }
        | MaterialKind::Hair(_)
        | MaterialKind::Interface => true,
        MaterialKind::Principled(principled) => principled.spec_trans != Textured::Value(0.0),
        _ => false,
    }
}

fn can_be_tinted(kind: &MaterialKind) -> bool {
    matches!(
        kind,
        MaterialKind::Conductor { .. } | MaterialKind::Dielectric { .. } | MaterialKind::ThinDielectric { .. }
    )
}
