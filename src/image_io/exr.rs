//! OpenEXR files: 32-bit float, lossless, with windows and metadata.
//!
//! Files are reproducible: the same image and metadata give the same bytes.

use super::image::Chromaticities;
use super::metadata::latin1;
use super::{Image, ImageMetadata, Window, check_length, image_error, read_bytes};
use crate::Result;
use ::exr::block::{BlockIndex, UncompressedBlock, writer::ChunksWriter};
use ::exr::meta::attribute::{self, ChannelDescription, SampleType};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::{
    AnyChannel, Compression, FlatSamples, IntegerBounds, LineOrder, ReadChannels, ReadLayers, Vec2, read as exr_reader,
};
use rayon::prelude::*;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// The primaries and white of Rec. 709 and sRGB, which an image has whose file does not say so.
const REC_709: Chromaticities = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];

/// Reads R, G, B and, if present, A of an EXR file, or Y and A of a grey one: half, float or integer samples, scan lines or tiles
/// (the largest level), any compression but HTJ2K and DWA's unsupported variants. Of several parts the first is read; other
/// channels are left out. The metadata is there only if Lucerna wrote the file.
///
/// # Errors
/// [`crate::Error::Io`] if the file cannot be read, [`crate::Error::Image`] if it is malformed, truncated, deep, subsampled, or has
/// no such channels.
pub fn read_exr(path: &Path) -> Result<(Image, Option<ImageMetadata>)> {
    decode(&read_bytes(path)?).map_err(|message| image_error(path, message))
}

/// The image in an EXR file's bytes, or what is wrong with them.
pub(super) fn decode(bytes: &[u8]) -> Result<(Image, Option<ImageMetadata>), String> {
    // The exr crate has panicked on malformed files. One thread, so that a panic is ours to catch.
    catch_unwind(AssertUnwindSafe(|| decode_unguarded(bytes)))
        .unwrap_or_else(|_| Err("malformed EXR file: the decoder gave up".to_owned()))
}

fn decode_unguarded(bytes: &[u8]) -> Result<(Image, Option<ImageMetadata>), String> {
    let headers = MetaData::read_from_buffered(bytes, false).map_err(explain)?.headers;
    for header in &headers {
        check_memory(header, bytes)?;
    }
    let file = exr_reader()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(explain)?;
    let layer = file.layer_data;
    let (names, planes) = choose_channels(&layer.channel_data.list)?;
    let data_window = window_from(layer.absolute_bounds())?;
    let display_window = window_from(file.attributes.display_window)?;
    let data = interleave(&planes, data_window.pixel_count());
    let image = Image::new(data_window, display_window, names, data).map_err(|error| error.to_string())?;
    let chromaticities = file
        .attributes
        .chromaticities
        .map(|c| [c.red, c.green, c.blue, c.white].map(|Vec2(x, y)| [x, y]));
    let metadata = ImageMetadata::from_attributes(&layer.attributes.other, chromaticities.unwrap_or(REC_709));
    Ok((image.with_chromaticities(chromaticities), metadata))
}

/// Refuses an image that memory cannot hold: a damaged header may ask for any size, and a failed allocation would end the process.
fn check_memory(header: &Header, file: &[u8]) -> Result<(), String> {
    let Vec2(width, height) = header.layer_size;
    let pixels = (width as u64).saturating_mul(height as u64);
    let bytes = pixels.saturating_mul(header.channels.bytes_per_pixel as u64);
    // Deflated, single precision may have lost a byte before; DWA makes a number of a block of 64 first.
    let most = match header.compression {
        Compression::DWAA(_) | Compression::DWAB(_) => 64 * 1032,
        _ => 1400,
    };
    check_length(bytes, file, most)?;
    let samples = width
        .checked_mul(height)
        .and_then(|pixels| pixels.checked_mul(header.channels.list.len()));
    // Twice: the decoded channels, and the interleaved copy.
    let fits = samples.is_some_and(|n| Vec::<[f32; 2]>::new().try_reserve_exact(n).is_ok());
    if fits {
        Ok(())
    } else {
        Err(format!("{width}x{height} pixels do not fit into memory"))
    }
}

/// The colour and alpha channels among a layer's, and their names in the order of the image.
fn choose_channels(list: &[AnyChannel<FlatSamples>]) -> Result<(Vec<String>, Vec<&FlatSamples>), String> {
    let find = |name: &str| list.iter().find(|channel| channel.name.eq(name));
    let wanted: &[&str] = if ["R", "G", "B"].iter().all(|name| find(name).is_some()) {
        &["R", "G", "B", "A"]
    } else if find("Y").is_some() {
        &["Y", "A"]
    } else {
        let found: Vec<_> = list.iter().map(|channel| channel.name.to_string()).collect();
        return Err(format!("no channels R, G, B or Y, only {}", found.join(", ")));
    };
    let chosen = wanted.iter().filter_map(|name| Some((name, find(name)?)));
    Ok(chosen
        .map(|(name, channel)| ((*name).to_owned(), &channel.sample_data))
        .unzip())
}

/// Channel by channel to pixel by pixel.
fn interleave(planes: &[&FlatSamples], pixel_count: usize) -> Vec<f32> {
    let mut data = vec![0.0; pixel_count * planes.len()];
    for (c, plane) in planes.iter().enumerate() {
        for (pixel, value) in data.chunks_exact_mut(planes.len()).zip(plane.values_as_f32()) {
            pixel[c] = value;
        }
    }
    data
}

/// The bytes of an EXR file of all the image's channels, with 32-bit float samples, ZIP compression and `metadata` as attributes.
pub(super) fn encode(image: &Image, metadata: Option<&ImageMetadata>) -> Result<Vec<u8>, String> {
    let mut file = Cursor::new(Vec::new());
    let header = header_of(image, metadata)?;
    // EXR stores channels in the order of their names' bytes.
    let mut order: Vec<usize> = (0..image.channels().len()).collect();
    order.sort_by_key(|&c| latin1(&image.channels()[c]));
    ::exr::block::write(&mut file, [header].into_iter().collect(), true, |meta, writer| {
        let blocks: Vec<_> = meta.enumerate_ordered_header_block_indices().collect();
        let compress = |(position, index): (usize, BlockIndex)| {
            let data = block_bytes(image, &order, index);
            let chunk = UncompressedBlock { index, data }.compress_to_chunk(&meta.headers)?;
            Ok((position, chunk))
        };
        // In the caller's thread pool, which keeps to the number of threads that the user asked for.
        let chunks: Vec<::exr::error::Result<_>> = blocks.into_par_iter().map(compress).collect();
        for chunk in chunks {
            let (position, chunk) = chunk?;
            writer.write_chunk(position, chunk)?;
        }
        Ok(())
    })
    .map_err(explain)?;
    let mut bytes = file.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

fn header_of(image: &Image, metadata: Option<&ImageMetadata>) -> Result<Header, String> {
    let mut channels: Vec<_> = image
        .channels()
        .iter()
        .map(|name| ChannelDescription::named(latin1(name), SampleType::F32))
        .collect();
    channels.sort_by(|a, b| a.name.cmp(&b.name));
    let size = Vec2(image.width(), image.height());
    let window = image.data_window();
    let attributes = LayerAttributes {
        layer_position: Vec2(window.x0, window.y0),
        other: metadata.map(ImageMetadata::to_attributes).unwrap_or_default(),
        ..LayerAttributes::default()
    };
    let display = image.display_window();
    let display = IntegerBounds::new((display.x0, display.y0), (display.width(), display.height()));
    // `end` of a window near the limits of 32 bits would overflow inside the crate.
    for bounds in [display, IntegerBounds::new((window.x0, window.y0), size)] {
        bounds.validate(None).map_err(explain)?;
    }
    let mut header = Header::new(latin1("image"), size, channels.into_iter().collect())
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_display_window(display)
        .with_attributes(attributes);
    let [red, green, blue, white] = metadata.map_or(REC_709, |m| m.chromaticities).map(|[x, y]| Vec2(x, y));
    header.shared_attributes.chromaticities = Some(attribute::Chromaticities {
        red,
        green,
        blue,
        white,
    });
    Ok(header)
}

/// The samples of some rows as EXR wants them: row by row, in it channel by channel in `order`.
fn block_bytes(image: &Image, order: &[usize], block: BlockIndex) -> Vec<u8> {
    let Vec2(first_column, first_row) = block.pixel_position;
    let Vec2(columns, rows) = block.pixel_size;
    let mut bytes = Vec::with_capacity(rows * columns * order.len() * size_of::<f32>());
    for y in first_row..first_row + rows {
        let start = (y * image.width() + first_column) * order.len();
        let row = &image.data()[start..start + columns * order.len()];
        for &c in order {
            bytes.extend(row[c..].iter().step_by(order.len()).flat_map(|v| v.to_ne_bytes()));
        }
    }
    bytes
}

/// Puts the attributes of a single-part file's header in the order of their names. The crate keeps them in a hash map and writes
/// them in an order that changes from run to run.
fn sort_attributes(file: &mut [u8]) {
    const HEADER_START: usize = 8;
    let end_of_text = |file: &[u8], start: usize| start + file[start..].iter().take_while(|&&b| b != 0).count();
    let mut attributes = Vec::new();
    let mut start = HEADER_START;
    while file[start] != 0 {
        // Name, NUL, type, NUL, size of the value in 4 bytes, value.
        let name_end = end_of_text(file, start);
        let type_end = end_of_text(file, name_end + 1);
        let size: [u8; 4] = std::array::from_fn(|i| file[type_end + 1 + i]);
        let end = type_end + 5 + u32::from_le_bytes(size) as usize;
        attributes.push(file[start..end].to_vec());
        start = end;
    }
    attributes.sort();
    file[HEADER_START..start].copy_from_slice(&attributes.concat());
}

fn window_from(bounds: IntegerBounds) -> Result<Window, String> {
    let Vec2(x0, y0) = bounds.position;
    let end = |start: i32, size: usize| {
        i32::try_from(size)
            .ok()
            .and_then(|size| start.checked_add(size))
            .ok_or_else(|| "a window reaches beyond the limits of EXR".to_owned())
    };
    Ok(Window {
        x0,
        y0,
        x1: end(x0, bounds.size.x())?,
        y1: end(y0, bounds.size.y())?,
    })
}

/// The message of the crate's error; reading and writing here is in memory, so an I/O error is one of the contents too.
fn explain(error: ::exr::error::Error) -> String {
    match error {
        ::exr::error::Error::NotSupported(what) => format!("EXR file with an unsupported feature: {what}"),
        ::exr::error::Error::Invalid(what) => format!("malformed EXR file: {what}"),
        other => format!("malformed EXR file: {other}"),
    }
}
