//! `twelvefold survey`: what the parts of a photograph must know of it.

use std::io::Write as _;

use twelvefold_files::failure::Failure;
use twelvefold_files::output::Output;
use twelvefold_files::picture::Scan;

use crate::args::SurveyOptions;
use crate::report;
use crate::survey::Survey;

/// Runs the subcommand.
pub(crate) fn run(options: &SurveyOptions) -> Result<(), Failure> {
    let SurveyOptions { photo, layer, output: path, .. } = options;
    let standard = path.as_os_str() == "-";
    let of_output = |error| report::of_output(path, error);
    let mut output =
        if standard { Ok(Output::standard()) } else { Output::create_from(path, photo) }
            .map_err(of_output)?;
    let tone = options.tone.tone()?;
    let of_photo = |error| report::of_input(photo, error);
    let mut scan = Scan::open(photo, tone, layer.as_deref()).map_err(of_photo)?;
    if !options.quiet {
        report::warn(photo, scan.warnings());
    }
    let survey = Survey::of(&mut scan, photo, tone, layer.as_deref()).map_err(of_photo)?;
    let written = output.write_all(survey.text().as_bytes()).map_err(Into::into);
    report::finish(path, written.and_then(|()| output.commit()))
}
