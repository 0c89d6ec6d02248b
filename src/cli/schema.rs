//! `dalembert schema`.

use super::outcome::{Outcome, Result};
use super::{models, print};
use crate::scene;

#[derive(Debug, clap::Args)]
pub struct SchemaArguments {
    /// Only scenes of this model, with its parameters, coordinates, inputs and choices
    model: Option<String>,
}

pub fn schema(arguments: &SchemaArguments) -> Result {
    let model = arguments.model.as_deref().map(models::find).transpose()?;
    print::output(format_args!("{:#}", scene::schema(model.as_deref())))?;
    Ok(Outcome::Done)
}
