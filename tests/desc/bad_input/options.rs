//! What applies to the whole picture: `Sampler`, `Integrator`, `ColorSpace`, `Option`.

use super::{Case, check};

#[test]
fn options() {
    let cases: [Case; 18] = [
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
        ("Integrator @\"mlt\" WorldBegin", "not supported yet", ""),
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
            "Integrator \"sppm\" \"float radius\" @-1 WorldBegin",
            "must be 0 or more",
            "",
        ),
        (
            "Integrator \"sppm\" \"string filter\" @\"con\" WorldBegin",
            "`filter` is one of",
            "`cone`",
        ),
        ("Sampler @\"sobl\" WorldBegin", "unknown sampler", "`sobol`"),
        ("ColorSpace @\"rec2021\" WorldBegin", "unknown color space", "`rec2020`"),
        ("@Option \"forcediffuse\" true WorldBegin", "not supported", ""),
        (
            "Integrator \"path\" @\"bool regularize\" true WorldBegin",
            "`regularize`",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
