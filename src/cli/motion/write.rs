//! Motions on the terminal and in files.

use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

use super::{File, Report, Told};
use crate::cli::table::Table;
use crate::motion::GRAVITY;
use crate::record::{FolderError, OutputFolder, exact, rounded};

/// File names of the tables; plots are called as [`Report::charts`] says.
const MEASURES: &str = "measures.csv";
const SPECTRA: &str = "spectra.csv";
/// Size of a plot, in pixels.
const SIZE: (f64, f64) = (900.0, 320.0);
/// Periods of the spectra that the terminal shows, at most.
const SHOWN: usize = 13;

impl File<'_> {
    /// The last part of its path.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        name.to_string_lossy().into_owned()
    }
}

impl Told {
    /// Time from the first to the last sample, s.
    pub fn duration(&self) -> f64 {
        let samples = &self.channel.samples;
        samples.time(samples.values.len() - 1) - samples.time(0)
    }

    /// What tables say of a channel, in the order of their columns: duration, PGA and its time, PGV, PGD, Arias intensity,
    /// significant duration, mean; m and s.
    pub fn numbers(&self) -> [f64; 8] {
        let m = &self.measures;
        [
            self.duration(),
            m.pga.value,
            m.pga.t,
            m.pgv.value,
            m.pgd.value,
            m.arias,
            m.significant_duration(),
            m.mean,
        ]
    }
}

impl Report<'_> {
    /// Writes tables and plots.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), FolderError> {
        folder.replace(|files| {
            files.file(MEASURES, |out| self.measures(out))?;
            files.file(SPECTRA, |out| self.spectra(out))?;
            for (name, chart) in self.charts() {
                let picture = chart.picture(SIZE, &self.appearance);
                files.picture(name, &picture, self.appearance.formats())?;
            }
            Ok(())
        })
    }

    /// Every channel with its label: its name, after that of its file if there are several.
    pub fn channels(&self) -> impl Iterator<Item = (String, &Told)> {
        let several = self.files.len() > 1;
        self.files.iter().flat_map(move |file| {
            let name = file.name();
            file.channels.iter().map(move |told| match several {
                true => (format!("{name} {}", told.channel.name), told),
                false => (told.channel.name.clone(), told),
            })
        })
    }

    /// One row a channel, numbers with the digits that read back to the same.
    fn measures(&self, out: impl Write) -> io::Result<()> {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record([
            "channel",
            "points",
            "duration [s]",
            "PGA [m/s^2]",
            "t of PGA [s]",
            "PGV [m/s]",
            "PGD [m]",
            "Arias intensity [m/s]",
            "5-95 % duration [s]",
            "mean [m/s^2]",
        ])?;
        for (label, told) in self.channels() {
            let points = told.channel.samples.values.len().to_string();
            csv.write_record([label, points].into_iter().chain(told.numbers().map(exact)))?;
        }
        csv.flush()
    }

    /// One row a period: of every channel the ordinate at samples and that at any time.
    fn spectra(&self, out: impl Write) -> io::Result<()> {
        let mut csv = csv::Writer::from_writer(out);
        let heads = self.channels().flat_map(|(label, _)| {
            [
                format!("{label}, at samples [m/s^2]"),
                format!("{label} [m/s^2]"),
            ]
        });
        csv.write_record(std::iter::once("T [s]".to_owned()).chain(heads))?;
        for (i, period) in self.periods.iter().enumerate() {
            let ordinates = self
                .channels()
                .flat_map(|(_, told)| [told.spectrum[i].samples, told.spectrum[i].peak]);
            csv.write_record(std::iter::once(*period).chain(ordinates).map(exact))?;
        }
        csv.flush()
    }
}

impl Display for Report<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        for file in &self.files {
            let motion = &file.record.motion;
            writeln!(f, "{}: {}", file.path.display(), motion.format.name())?;
            for (key, value) in &motion.details {
                writeln!(f, "  {key}: {value}")?;
            }
            for note in motion.notes.iter().filter(|note| !note.doubt) {
                writeln!(f, "  line {}: {}", file.record.line(note), note.message)?;
            }
            writeln!(f)?;
        }
        let heads = [
            "channel",
            "points",
            "step s",
            "PGA m/s²",
            "g",
            "at s",
            "PGV m/s",
            "PGD m",
            "Arias m/s",
            "5–95 % s",
            "mean m/s²",
        ];
        let mut table = Table::new(heads).right(1..heads.len());
        for (label, told) in self.channels() {
            let (m, samples) = (&told.measures, &told.channel.samples);
            table.row([
                label,
                samples.values.len().to_string(),
                samples.dt().map_or("unequal".into(), |dt| rounded(dt, 4)),
                rounded(m.pga.value, 4),
                rounded(m.pga.value / GRAVITY, 4),
                rounded(m.pga.t, 5),
                rounded(m.pgv.value, 4),
                rounded(m.pgd.value, 4),
                rounded(m.arias, 4),
                rounded(m.significant_duration(), 4),
                rounded(m.mean, 2),
            ]);
        }
        writeln!(f, "{table}\n")?;
        let heads = self.channels().map(|(label, _)| format!("{label} m/s²"));
        let heads: Vec<String> = std::iter::once("T s".to_owned()).chain(heads).collect();
        let mut table = Table::new(&heads).right(0..heads.len());
        let every = self.periods.len().div_ceil(SHOWN).max(1);
        for i in (0..self.periods.len()).step_by(every) {
            let ordinates = self.channels().map(|(_, told)| told.spectrum[i].peak);
            let row = std::iter::once(self.periods[i]).chain(ordinates);
            table.row(row.map(|x| rounded(x, 4)));
        }
        writeln!(f, "pseudo-acceleration, damping {}", self.damping)?;
        write!(f, "{table}")
    }
}
