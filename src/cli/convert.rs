//! `lucerna convert`.

use std::path::Path;

use super::args::ConvertArgs;
use super::report::{Channel, Reporter};
use crate::desc::{self, ParseOptions, SceneDesc, pbrt};
use crate::error::{Error, Result};

/// Reads a scene and writes it as a pbrt-v4 file; says what of it pbrt does not know.
pub fn run(args: &ConvertArgs) -> Result<()> {
    if args.output.extension().is_none_or(|extension| extension != "pbrt") {
        return Err(Error::Usage(format!(
            "{}: scenes are written as pbrt-v4 files (expected the extension .pbrt)",
            args.output.display()
        )));
    }
    let reporter = Reporter {
        channel: Channel::Person,
        scene: &args.scene,
        camera: "",
    };
    let options = ParseOptions {
        lenient: args.lenient,
        defines: args.defines.clone(),
    };
    let desc = desc::load(&args.scene, &options)?;
    check_sources(&desc, &args.output)?;
    reporter.warnings(&desc.warnings);
    for extension in pbrt::write(&desc, &args.output)? {
        let file = args.output.display();
        reporter.say(&format!(
            "{file}: beyond pbrt-v4, an extension of Lucerna's: {extension}"
        ));
    }
    Ok(())
}

/// Refuses to write over a file that the scene was read from.
fn check_sources(desc: &SceneDesc, output: &Path) -> Result<()> {
    let Ok(place) = output.canonicalize() else {
        return Ok(());
    };
    if desc
        .sources
        .paths()
        .any(|path| path.canonicalize().is_ok_and(|path| path == place))
    {
        return Err(Error::Usage(format!(
            "{}: the scene is read from this file; write it to another",
            output.display()
        )));
    }
    Ok(())
}
