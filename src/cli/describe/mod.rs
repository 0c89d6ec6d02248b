//! `dalembert describe`.

mod description;
mod text;

use super::outcome::{Failure, Outcome, Result};
use super::{folders, models, print};
use crate::model::{Model, Variant};
use description::Description;

#[derive(Debug, clap::Args)]
pub struct DescribeArguments {
    /// Name of the model, or a model folder: anything with a slash is one
    model: String,
    /// Choose an option, such as `rules=paper`; other choices keep their defaults
    #[arg(long = "set", value_name = "CHOICE=OPTION")]
    choices: Vec<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn describe(arguments: &DescribeArguments) -> Result {
    let pairs = arguments
        .choices
        .iter()
        .filter_map(|pair| pair.split_once('='));
    let named = pairs.map(|(choice, option)| (choice.to_owned(), option.to_owned()));
    let model = folders::find(&arguments.model, named.collect())?;
    let variant = choose(&model, &arguments.choices)?;
    let description = Description::new(&model, variant);
    if arguments.json {
        let json = serde_json::to_string_pretty(&description).map_err(Failure::system)?;
        print::output(json)?;
    } else {
        print::output(text::Text(&description))?;
    }
    Ok(Outcome::Done)
}

/// The variant with the options asked for, and the defaults of all other choices.
fn choose<'m>(model: &'m Model, asked: &[String]) -> std::result::Result<&'m Variant, Failure> {
    let mut wanted: Vec<Option<&str>> = vec![None; model.choices.len()];
    for setting in asked {
        let Some((name, option)) = setting.split_once('=') else {
            return Err(Failure::wrong_input(format!(
                "`--set {setting}`: expected CHOICE=OPTION, such as `rules=paper`"
            )));
        };
        let names: Vec<&str> = model.choices.iter().map(|c| c.name).collect();
        let i = models::place("choice", name, &names)?;
        models::place("option", option, &model.choices[i].options)?;
        wanted[i] = Some(option);
    }
    let fits = |variant: &&Variant| {
        wanted.iter().enumerate().all(|(i, wanted)| match wanted {
            Some(option) => variant.options[i] == *option,
            None => variant.defaults[i],
        })
    };
    model.variants.iter().find(fits).ok_or_else(|| {
        let asked = asked.join(", ");
        Failure::wrong_input(format!("the model does not offer {asked} together"))
    })
}
