//! Output files that appear whole or not at all.
//!
//! A render may take hours: whatever would keep its image from being written is found before it starts, the old file stays in
//! place until the new one is complete, and a finished image is written somewhere even if its place has gone.

use super::{Image, ImageMetadata, exr, image_error, png};
use crate::{Error, Result};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The kinds of file that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// 32-bit float, linear, with metadata.
    Exr,
    /// 8-bit sRGB.
    Png,
}

impl ImageFormat {
    /// The format that a file's extension names, in upper or lower case.
    ///
    /// # Errors
    /// [`Error::Usage`] for any other extension, or none.
    pub fn of_path(path: &Path) -> Result<Self> {
        match path.extension().map(std::ffi::OsStr::to_ascii_lowercase) {
            Some(extension) if extension == "exr" => Ok(Self::Exr),
            Some(extension) if extension == "png" => Ok(Self::Png),
            _ => Err(Error::Usage(format!(
                "{}: the output's name must end in .exr or .png",
                path.display()
            ))),
        }
    }
}

/// An output file that is known to be writable and is not written yet. Dropped, it leaves nothing behind.
#[derive(Debug)]
pub struct PendingOutput {
    /// As the user named it.
    path: PathBuf,
    /// What is replaced: `path`, or the file it links to.
    target: PathBuf,
    format: ImageFormat,
}

/// Where an image has been written.
#[derive(Debug)]
pub struct Written {
    /// The file.
    pub path: PathBuf,
    /// Why it is not the file that was asked for; `None` if it is.
    pub instead_because: Option<Error>,
}

impl PendingOutput {
    /// Checks, before a render, that `path` can be written after it: by its extension, and by creating and removing a temporary
    /// file beside it. Nothing stays on the disk, so that an interrupted render leaves no litter.
    ///
    /// # Errors
    /// [`Error::Usage`] if the extension is neither `.exr` nor `.png`; [`Error::Io`] if `path` is something other than a regular
    /// file, or its directory is missing or cannot be written to.
    pub fn create(path: &Path) -> Result<Self> {
        let format = ImageFormat::of_path(path)?;
        let failed = |source: io::Error| Error::io("create", path, source);
        let target = follow_links(path).map_err(failed)?;
        match fs::metadata(&target) {
            Ok(existing) if existing.is_dir() => return Err(failed(io::ErrorKind::IsADirectory.into())),
            Ok(existing) if !existing.is_file() => return Err(failed(io::Error::other("not a regular file"))),
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(failed(error)),
        }
        temporary_in(directory_of(&target)).map_err(failed)?;
        Ok(Self {
            path: path.to_owned(),
            target,
            format,
        })
    }

    /// The file, as given to [`PendingOutput::create`].
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The kind of file.
    pub fn format(&self) -> ImageFormat {
        self.format
    }

    /// Writes the image to a temporary file beside the target, syncs it to the disk and renames it over the target.
    ///
    /// If that fails, the image goes into the working directory, or else the system's directory of temporary files, under the
    /// same name, or one with a number appended where that name is taken; the result says so. `metadata` goes into EXR files;
    /// `exposure`, in stops, applies to PNG files.
    ///
    /// # Errors
    /// [`Error::Image`] if the image cannot be encoded (a PNG file needs colour channels), [`Error::Io`] if nowhere can it be
    /// written; in either case the target is as it was.
    pub fn commit(self, image: &Image, metadata: Option<&ImageMetadata>, exposure: f32) -> Result<Written> {
        self.commit_or_fall_back(image, metadata, exposure, &[Path::new("."), &std::env::temp_dir()])
    }

    fn commit_or_fall_back(
        self,
        image: &Image,
        metadata: Option<&ImageMetadata>,
        exposure: f32,
        fallbacks: &[&Path],
    ) -> Result<Written> {
        let bytes = match self.format {
            ImageFormat::Exr => exr::encode(image, metadata),
            ImageFormat::Png => png::encode(image, exposure),
        }
        .map_err(|message| image_error(&self.path, message))?;
        let replaced = written_temporary(directory_of(&self.target), &bytes)
            .and_then(|file| file.persist(&self.target).map_err(|error| error.error));
        let reason = match replaced {
            Ok(_) => {
                sync_directory(directory_of(&self.target));
                return Ok(Written {
                    path: self.path,
                    instead_because: None,
                });
            }
            Err(source) => Error::io("write", &self.path, source),
        };
        for directory in fallbacks {
            if let Ok(path) = write_unclaimed(directory, &self.path, &bytes) {
                return Ok(Written {
                    path,
                    instead_because: Some(reason),
                });
            }
        }
        Err(reason)
    }
}

/// `path`, or what it links to: a rename would replace the link and leave the file it names as it was.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    match fs::symlink_metadata(path) {
        Ok(metadata) if metadata.is_symlink() => fs::canonicalize(path),
        _ => Ok(path.to_owned()),
    }
}

/// The directory that holds `path`.
fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// A new hidden file in `directory`, removed when dropped, with the permissions of any new file.
fn temporary_in(directory: &Path) -> io::Result<NamedTempFile> {
    if !directory.is_dir() {
        let missing = format!("there is no directory {}", directory.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, missing));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lucerna-").suffix(".tmp");
    // The default is private to the user; the umask still applies to this.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    // Without the name of the temporary file, which says nothing to anybody.
    builder.tempfile_in(directory).map_err(|error| match error.kind() {
        kind @ (io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem) => {
            kind.into()
        }
        _ => error,
    })
}

/// A temporary file in `directory` that holds `bytes` and is on the disk.
fn written_temporary(directory: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut file = temporary_in(directory)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// Replaces the file `path`, which need not exist, by one that holds `bytes`, all at once.
///
/// # Errors
/// [`Error::Io`]; then the file is as it was.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let replaced = follow_links(path).and_then(|target| {
        let file = written_temporary(directory_of(&target), bytes)?;
        file.persist(&target).map_err(|error| error.error)
    });
    replaced.map(|_| ()).map_err(|source| Error::io("write", path, source))
}

/// Makes a rename in `directory` last through a power cut, where the system can; the file's contents are safe already.
fn sync_directory(directory: &Path) {
    let _ = File::open(directory).and_then(|directory| directory.sync_all());
}

/// Writes `bytes` into `directory` under the file name of `path`, or `NAME-1.EXT` and so on if there is such a file: nobody agreed
/// to have one here replaced.
fn write_unclaimed(directory: &Path, path: &Path, bytes: &[u8]) -> io::Result<PathBuf> {
    const ATTEMPTS: usize = 1000;
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, extension) = (part(path.file_stem()), part(path.extension()));
    let mut file = written_temporary(directory, bytes)?;
    for attempt in 0..ATTEMPTS {
        let number = if attempt == 0 {
            String::new()
        } else {
            format!("-{attempt}")
        };
        let candidate = directory.join(format!("{stem}{number}.{extension}"));
        match file.persist_noclobber(&candidate) {
            Ok(_) => {
                sync_directory(directory);
                return Ok(candidate);
            }
            Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => file = error.file,
            Err(error) => return Err(error.error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

#[cfg(test)]
mod tests {
    use super::super::{Window, read};
    use super::*;
    use tempfile::tempdir;

    fn image() -> Image {
        let window = Window::of_size(2, 1);
        Image::rgb(window, window, vec![0.0, 0.25, 0.5, 1.0, 2.0, 4.0]).unwrap()
    }

    #[test]
    fn an_image_that_lost_its_place_goes_elsewhere() {
        let (place, elsewhere) = (tempdir().unwrap(), tempdir().unwrap());
        let target = place.path().join("out.exr");
        let commit = || {
            let pending = PendingOutput::create(&target).unwrap();
            // A directory in the target's place cannot be replaced by a rename.
            fs::create_dir(&target).unwrap();
            let missing = place.path().join("missing");
            let written = pending.commit_or_fall_back(&image(), None, 0.0, &[&missing, elsewhere.path()]);
            fs::remove_dir(&target).unwrap();
            written.unwrap()
        };
        for name in ["out.exr", "out-1.exr", "out-2.exr"] {
            let written = commit();
            assert_eq!(written.path, elsewhere.path().join(name));
            assert!(matches!(
                written.instead_because,
                Some(Error::Io { action: "write", .. })
            ));
            assert_eq!(read(&written.path).unwrap().data(), image().data());
        }
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
        assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 3);
    }

    #[test]
    fn nowhere_to_write_is_an_error() {
        let place = tempdir().unwrap();
        let directory = place.path().join("gone");
        fs::create_dir(&directory).unwrap();
        let pending = PendingOutput::create(&directory.join("out.png")).unwrap();
        fs::remove_dir(&directory).unwrap();
        let written = pending.commit_or_fall_back(&image(), None, 0.0, &[&directory]);
        assert!(matches!(written, Err(Error::Io { action: "write", .. })));
    }
}
