//! The page of a study of precision.

use super::Precision;
use super::write::described;
use crate::cli::page::command_line;
use crate::page::{Page, Table};
use crate::record::plot::Chart;
use crate::scene::Scene;

impl Precision {
    /// Time against error, what the runs were compared with, advice, and the table of runs.
    pub fn page(&self, scene: &Scene) -> String {
        let mut page = Page::new(&format!("{}: precision", self.title));
        page.set_units(&self.appearance.units);
        if !self.study.is_complete() {
            page.alarm("Interrupted: some of the runs are missing.");
        }
        let Some(reference) = &self.study.reference else {
            page.alarm("The reference is not there, so nothing can be compared.");
            page.source("The scene", &command_line(), &scene.source.json());
            return page.finish();
        };
        described(reference)
            .lines()
            .for_each(|line| page.paragraph(line));
        self.advice_lines(reference)
            .iter()
            .for_each(|line| page.paragraph(line));
        page.heading("Time against error");
        page.note("Drag to zoom, double-click for the whole; beside a point its values are shown.");
        // The page has the title.
        page.chart(&Chart {
            title: String::new(),
            ..self.chart()
        });
        page.heading("Runs");
        let mut table = Table::new(self.heads());
        for row in self.shown_rows(reference.bound) {
            table.row(row);
        }
        page.table(&table);
        self.stopped().iter().for_each(|line| page.alarm(line));
        page.source("The scene", &command_line(), &scene.source.json());
        page.finish()
    }
}
