//! `dalembert schema`.

use super::outcome::{Outcome, Result};
use super::{models, print};
use crate::{scene, study};

#[derive(Debug, clap::Args)]
pub struct SchemaArguments {
    /// Only scenes of this model, with its parameters, coordinates, inputs and choices
    #[arg(conflicts_with = "study")]
    model: Option<String>,
    /// The format of studies instead
    #[arg(long)]
    study: bool,
}

pub fn schema(arguments: &SchemaArguments) -> Result {
    if arguments.study {
        print::output(format_args!("{:#}", study::schema()))?;
        return Ok(Outcome::Done);
    }
    let model = arguments.model.as_deref().map(models::find).transpose()?;
    print::output(format_args!("{:#}", scene::schema(model.as_deref())))?;
    Ok(Outcome::Done)
}
