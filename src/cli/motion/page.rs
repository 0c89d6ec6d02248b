//! The page of motions.

use super::Report;
use crate::cli::page::command_line;
use crate::page::{Cell, Page, Table};

/// Plots before this one are over time.
const FIRST_SPECTRUM: usize = 4;

impl Report<'_> {
    /// What is in the files, their measures, and plots.
    pub fn page(&self) -> String {
        let names: Vec<String> = self.files.iter().map(|file| file.name()).collect();
        let mut page = Page::new(&format!("Ground motion: {}", names.join(", ")));
        page.set_units(&self.appearance.units);
        for (name, file) in names.iter().zip(&self.files) {
            let motion = &file.record.motion;
            page.paragraph(&format!("{name}: {}", motion.format.name()));
            let details = motion.details.iter();
            let details: Vec<String> = details
                .map(|(key, text)| format!("{key}: {text}"))
                .collect();
            if !details.is_empty() {
                page.note(&details.join(" · "));
            }
            for note in &motion.notes {
                let told = format!("{name}, line {}: {}", file.record.line(note), note.message);
                match note.doubt {
                    true => page.alarm(&told),
                    false => page.note(&told),
                }
            }
        }
        page.table(&self.table());
        let charts = self.charts();
        let (over_time, spectra) = charts.split_at(FIRST_SPECTRUM);
        page.heading("Over time");
        page.note(
            "Velocity and displacement are zero at the first sample. Drag to zoom all plots, double-click for the whole.",
        );
        for (_, chart) in over_time {
            page.chart(chart);
        }
        page.heading("Response spectra");
        page.note("Of the largest displacement relative to the ground at any time, also after the record.");
        for (_, chart) in spectra {
            page.chart(chart);
        }
        page.heading("Made by");
        page.listing(&command_line());
        page.finish()
    }

    /// One row a channel.
    fn table(&self) -> Table {
        let heads = [
            ("duration", "s"),
            ("PGA", "m/s^2"),
            ("at", "s"),
            ("PGV", "m/s"),
            ("PGD", "m"),
            ("Arias intensity", "m/s"),
            ("5–95 % duration", "s"),
            ("mean", "m/s^2"),
        ];
        let words = heads.iter().map(|(words, _)| *words);
        let mut table = Table::new(["channel", "points"].into_iter().chain(words));
        for (i, (_, unit)) in heads.iter().enumerate() {
            table = table.unit(i + 2, unit);
        }
        for (label, told) in self.channels() {
            let points = Cell::plain(told.channel.samples.values.len() as f64);
            let numbers = told.numbers().into_iter().zip(heads);
            let numbers = numbers.map(|(x, (_, unit))| Cell::Number(x, unit.to_owned()));
            table.row([Cell::from(label), points].into_iter().chain(numbers));
        }
        table
    }
}
