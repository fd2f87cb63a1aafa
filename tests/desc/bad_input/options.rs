//! What applies to the whole picture: `Sampler`, `Integrator`, `ColorSpace`, `Option`.

use super::{Case, check};

#[test]
fn options() {
    let cases: [Case; 13] = [
        (
            "Sampler \"sobol\" \"integer pixelsamples\" @0 WorldBegin",
            "must be 1 to 16777216",
            "",
        ),
        (
            "Integrator \"path\" \"integer maxdepth\" @-2 WorldBegin",
            "must be -1 or more",
            "",
        ),
        (
            "Integrator \"path\" \"string lightsampler\" @\"pwoer\" WorldBegin",
            "`lightsampler` is one of",
            "`power`",
        ),
        (
            "Sampler \"stratified\" \"integer xsamples\" @0 WorldBegin",
            "must be 1 to 4096",
            "",
        ),
        (
            "Sampler \"sobol\" @\"bool jitter\" false WorldBegin",
            "no parameter `jitter`",
            "",
        ),
        (
            "Integrator \"kajiya\" \"float alpha\" @1 WorldBegin",
            "must be between 0.05 and 0.95",
            "",
        ),
        ("@Option \"sead\" 1 WorldBegin", "unknown option `sead`", "`seed`"),
        (
            "Integrator @\"function\" WorldBegin",
            "not supported: it integrates",
            "",
        ),
        (
            "Integrator @\"simpelpath\" WorldBegin",
            "unknown integrator",
            "`simplepath`",
        ),
        (
            "@Option \"pixelstats\" \"maybe\" WorldBegin",
            "`true` or `false`, not `\"maybe\"`",
            "",
        ),
        ("Sampler @\"sobl\" WorldBegin", "unknown sampler", "`sobol`"),
        ("ColorSpace @\"rec2021\" WorldBegin", "unknown color space", "`rec2020`"),
        ("@Option \"forcediffuse\" true WorldBegin", "not supported", ""),
    ];
    cases.iter().for_each(check);
}

#[test]
fn photon_mapping() {
    let cases: [Case; 11] = [
        (
            "Integrator \"photon\" \"integer passes\" @0 WorldBegin",
            "must be 1 to",
            "",
        ),
        (
            "Integrator \"photon\" \"integer causticphotons\" @-2 WorldBegin",
            "must be -1 to",
            "",
        ),
        (
            "Integrator \"photon\" \"integer globalphotons\" @-2 WorldBegin",
            "must be -1 to",
            "",
        ),
        (
            "Integrator \"photon\" \"integer nused\" @0 WorldBegin",
            "must be 1 to",
            "",
        ),
        (
            "Integrator \"photon\" \"float maxdist\" @-1 WorldBegin",
            "must be 0 or more",
            "",
        ),
        (
            "Integrator \"photon\" \"integer finalgathersamples\" @0 WorldBegin",
            "must be 1 to",
            "",
        ),
        (
            "Integrator \"photon\" \"string filter\" @\"con\" WorldBegin",
            "`filter` is one of",
            "`cone`",
        ),
        (
            "Integrator \"photon\" @\"float radius\" 1 WorldBegin",
            "no parameter `radius`",
            "",
        ),
        (
            "Integrator \"sppm\" \"integer photonsperiteration\" @-2 WorldBegin",
            "must be -1 to",
            "",
        ),
        (
            "Integrator \"sppm\" \"float radius\" @-1 WorldBegin",
            "must be 0 or more",
            "",
        ),
        (
            "Integrator \"sppm\" @\"integer passes\" 3 WorldBegin",
            "no parameter `passes`",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
