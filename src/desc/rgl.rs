//! Measured materials in the tensor format of RGL's database (Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient
//! Material Acquisition and Rendering").

use std::collections::HashMap;
use std::path::PathBuf;

/// A grid of numbers, the last index running fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// How many entries along each axis.
    pub shape: Vec<usize>,
    /// All entries.
    pub values: Vec<f32>,
}

/// A measured material. Shapes agree with one another; every number is finite and not negative but for angles.
#[derive(Clone, Debug)]
pub struct MeasuredDesc {
    /// The file that it was read from.
    pub path: PathBuf,
    /// Azimuths of the incident direction, increasing; one or two for an isotropic material.
    pub phi: Vec<f32>,
    /// Its polar angles, increasing, at least two.
    pub theta: Vec<f32>,
    /// In nm, increasing.
    pub wavelengths: Vec<f32>,
    /// Density of facets by normal.
    pub ndf: Tensor,
    /// Projected area of facets by direction.
    pub sigma: Tensor,
    /// Density of visible normals, by phi and theta.
    pub vndf: Tensor,
    /// Luminance over samples of those, by phi and theta.
    pub luminance: Tensor,
    /// Reflectance over samples of those, by phi, theta and wavelength.
    pub spectra: Tensor,
}

const HEADER: &[u8; 12] = b"tensor_file\0";
/// The types of numbers that are read: bytes and single precision.
const UINT8: u8 = 1;
const FLOAT32: u8 = 10;

/// Reads the bytes of a file.
///
/// # Errors
/// What is wrong with them.
pub fn parse(bytes: &[u8]) -> Result<MeasuredDesc, String> {
    let mut fields = fields(bytes)?;
    let mut take = |name: &str, axes: usize| -> Result<Tensor, String> {
        let tensor = fields.remove(name).ok_or(format!("the field `{name}` is missing"))?;
        if tensor.shape.len() != axes || tensor.shape.contains(&0) {
            return Err(format!("the field `{name}` has the shape {:?}", tensor.shape));
        }
        Ok(tensor)
    };
    let desc = MeasuredDesc {
        path: PathBuf::new(),
        phi: take("phi_i", 1)?.values,
        theta: take("theta_i", 1)?.values,
        wavelengths: take("wavelengths", 1)?.values,
        ndf: take("ndf", 2)?,
        sigma: take("sigma", 2)?,
        vndf: take("vndf", 4)?,
        luminance: take("luminance", 4)?,
        spectra: take("spectra", 5)?,
    };
    check(&desc)?;
    Ok(desc)
}

fn check(desc: &MeasuredDesc) -> Result<(), String> {
    let (phis, thetas, lines) = (desc.phi.len(), desc.theta.len(), desc.wavelengths.len());
    let rising = |values: &[f32]| values.windows(2).all(|pair| pair[0] < pair[1]);
    for (name, values) in [
        ("phi_i", &desc.phi),
        ("theta_i", &desc.theta),
        ("wavelengths", &desc.wavelengths),
    ] {
        if !rising(values) || values.iter().any(|v| !v.is_finite()) {
            return Err(format!("the values of `{name}` must increase"));
        }
    }
    if thetas < 2 {
        return Err("`theta_i` has fewer than two angles".to_owned());
    }
    let turn = std::f32::consts::TAU;
    if phis > 2 && (desc.phi[phis - 1] - desc.phi[0] - turn).abs() > 0.1 {
        return Err("`phi_i` covers only a part of the circle, which is not supported".to_owned());
    }
    let lead = |tensor: &Tensor, expected: &[usize]| tensor.shape[..expected.len()] == *expected;
    for (name, tensor, expected) in [
        ("vndf", &desc.vndf, &[phis, thetas][..]),
        ("luminance", &desc.luminance, &[phis, thetas]),
        ("spectra", &desc.spectra, &[phis, thetas, lines]),
        ("ndf", &desc.ndf, &[]),
        ("sigma", &desc.sigma, &[]),
    ] {
        let grid = &tensor.shape[tensor.shape.len() - 2..];
        if !lead(tensor, expected) || grid.iter().any(|&n| n < 2) {
            return Err(format!("the shape {:?} of `{name}` does not fit", tensor.shape));
        }
        if tensor.values.iter().any(|v| !v.is_finite()) {
            return Err(format!("`{name}` has a value that is not finite"));
        }
    }
    Ok(())
}

/// A place in the file.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(count).filter(|&end| end <= self.bytes.len());
        let end = end.ok_or("the file is truncated")?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    /// A little-endian number of `count` bytes, at most 8.
    fn number(&mut self, count: usize) -> Result<u64, String> {
        Ok(self
            .take(count)?
            .iter()
            .rev()
            .fold(0, |n, &byte| n << 8 | u64::from(byte)))
    }
}

/// The fields that are read. Others may be there, any number of them over the same bytes.
const FIELDS: [&str; 8] = [
    "phi_i",
    "theta_i",
    "wavelengths",
    "ndf",
    "sigma",
    "vndf",
    "luminance",
    "spectra",
];

/// The fields that are read, of bytes or of numbers in single precision, by name.
fn fields(bytes: &[u8]) -> Result<HashMap<String, Tensor>, String> {
    let mut cursor = Cursor { bytes, at: 0 };
    if cursor.take(HEADER.len())? != HEADER {
        return Err("this is no tensor file".to_owned());
    }
    if cursor.take(2)? != [1, 0] {
        return Err("this version of tensor files is not known".to_owned());
    }
    let count = cursor.number(4)?;
    let mut fields = HashMap::new();
    for _ in 0..count {
        let length = cursor.number(2)? as usize;
        let name = String::from_utf8_lossy(cursor.take(length)?).into_owned();
        let axes = cursor.number(2)?;
        let kind = cursor.number(1)? as u8;
        let offset = cursor.number(8)?;
        let mut shape = Vec::new();
        for _ in 0..axes {
            shape.push(usize::try_from(cursor.number(8)?).map_err(|e| e.to_string())?);
        }
        if fields.contains_key(&name) {
            return Err(format!("the field `{name}` is there twice"));
        }
        if FIELDS.contains(&name.as_str())
            && let Some(tensor) = tensor(bytes, kind, offset, shape)?
        {
            fields.insert(name, tensor);
        }
    }
    Ok(fields)
}

/// A field's numbers; `None` if they are of another type than those that are read.
fn tensor(bytes: &[u8], kind: u8, offset: u64, shape: Vec<usize>) -> Result<Option<Tensor>, String> {
    let size = match kind {
        UINT8 => 1,
        FLOAT32 => 4,
        _ => return Ok(None),
    };
    let length = shape.iter().try_fold(size, |n: usize, &axis| n.checked_mul(axis));
    let mut data = Cursor {
        bytes,
        at: usize::try_from(offset).map_err(|e| e.to_string())?,
    };
    let data = data.take(length.ok_or("a field is too large")?)?;
    let values = if kind == UINT8 {
        data.iter().map(|&byte| f32::from(byte)).collect()
    } else {
        data.chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect()
    };
    Ok(Some(Tensor { shape, values }))
}
