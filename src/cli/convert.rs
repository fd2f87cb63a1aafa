//! `lucerna convert`.

use super::args::ConvertArgs;
use super::report::{Channel, Reporter};
use crate::desc::{self, ParseOptions, pbrt};
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
    reporter.warnings(&desc.warnings);
    for extension in pbrt::write(&desc, &args.output)? {
        let file = args.output.display();
        reporter.say(&format!(
            "{file}: beyond pbrt-v4, an extension of Lucerna's: {extension}"
        ));
    }
    Ok(())
}
