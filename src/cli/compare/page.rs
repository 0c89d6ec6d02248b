//! The page of a comparison.

use super::Comparison;
use crate::cli::page::command_line;
use crate::page::{Cell, Page, Table};
use crate::record::ColumnKind;
use crate::scene::Scene;

impl Comparison<'_> {
    /// Every coordinate and rate over time, one curve a variant, and the table.
    pub fn page(&self, scene: &Scene) -> String {
        let title = scene.problem.title.as_deref().unwrap_or(self.model.name);
        let mut page = Page::new(&format!("{title}: compared"));
        page.set_units(&self.appearance.units);
        page.paragraph(&format!("{}: {}", self.model.name, self.choices.join(", ")));
        for case in &self.cases {
            if let Some(reason) = case.reason() {
                page.alarm(&format!("{}, {}: {reason}", case.label(), case.outcome()));
            }
        }
        page.heading("Over time");
        page.note("Drag to zoom all plots, double-click for the whole. Where curves lie on each other their colours alternate.");
        let coordinates = self.coordinates();
        if coordinates.is_empty() {
            page.note("No coordinate moves in any of the runs, so there is nothing to draw.");
        }
        for group in [ColumnKind::Coordinate, ColumnKind::Velocity] {
            for &i in &coordinates {
                page.chart(&self.chart(i, group));
            }
        }
        page.heading("Numbers");
        let labels = self.cases.iter().map(|case| case.label());
        let heads = [String::new(), "unit".into()].into_iter().chain(labels);
        let mut table = Table::new(heads);
        let outcomes = self.cases.iter().map(|case| Cell::from(case.outcome()));
        table.row(
            [Cell::from("outcome"), "".into()]
                .into_iter()
                .chain(outcomes),
        );
        for measure in self.measures() {
            let value = |x: &Option<f64>| match x {
                Some(x) => Cell::Number(*x, measure.unit.clone()),
                None => Cell::from("–"),
            };
            let cells: Vec<Cell> = measure.values.iter().map(value).collect();
            let name = [Cell::from(measure.name), Cell::Unit(measure.unit.clone())];
            table.row(name.into_iter().chain(cells));
        }
        page.table(&table);
        page.source("The scene", &command_line(), &scene.source.json());
        page.finish()
    }
}
