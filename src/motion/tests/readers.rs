//! Each format against what independent readers found in the same file.

use super::super::{Format, Measures, READERS, Times, Unit, text::Page};
use super::*;

/// What was found, in m and s: points, step, peak, its time, mean, velocity at samples, Arias
/// intensity; and the largest relative difference.
struct Found {
    points: usize,
    dt: f64,
    pga: f64,
    t: f64,
    mean: f64,
    pgv: f64,
    arias: f64,
}

fn assert_near(value: f64, expected: f64, relative: f64, what: &str) {
    let error = (value - expected).abs();
    assert!(
        error <= relative * expected.abs(),
        "{what}: {value} is not {expected}"
    );
}

#[track_caller]
fn assert_found(samples: &Samples, found: &Found) {
    let m = Measures::of(samples);
    assert_eq!(samples.values.len(), found.points);
    assert_near(samples.dt().expect("one step"), found.dt, 1e-12, "dt");
    assert_near(m.pga.value, found.pga, 1e-12, "pga");
    assert_near(m.pga.t, found.t, 1e-12, "time of the peak");
    assert_near(m.mean, found.mean, 1e-9, "mean");
    assert_near(m.pgv.value, found.pgv, 1e-11, "pgv");
    assert_near(m.arias, found.arias, 1e-11, "arias");
}

#[test]
fn smc_whose_columns_touch() {
    let found = Found {
        points: 6001,
        dt: 0.005,
        pga: 1.0441,
        t: 10.17,
        mean: -3.593868538576904e-05,
        pgv: 0.08086537992,
        arias: 0.0954276129017227,
    };
    assert_found(&samples(SMC), &found);
    let found = Found {
        points: 6012,
        dt: 0.005,
        pga: -2.6349,
        t: 3.4,
        mean: 0.026154993506819695,
        pgv: 0.786047839815,
        arias: 0.5746188691175129,
    };
    assert_found(&samples(record_file!("0165a_u.smc")), &found);
}

#[test]
fn cosmos_has_its_step_in_milliseconds() {
    let found = Found {
        points: 7000,
        dt: 0.01,
        pga: -1.619618,
        t: 27.85,
        mean: 4.680000000000007e-08,
        pgv: -0.0577398085,
        arias: 0.10359794378423472,
    };
    assert_found(&samples(COSMOS), &found);
}

#[test]
fn cosmos_files_hold_several_channels_and_unknown_codes() {
    let text = String::from_utf8(COSMOS.to_vec()).expect("ASCII");
    let other = text.replacen(
        "       2       1       4     120",
        "    -999    -999       4     120",
        1,
    );
    let both = format!("{text}{other}");
    let motion = open(both.as_bytes(), &Given::default()).expect("two channels");
    assert_eq!(motion.channels.len(), 2);
    assert_eq!(motion.channels[0].samples, motion.channels[1].samples);
}

#[test]
fn at2_in_g() {
    let channel = channel(AT2);
    assert_eq!(
        (channel.samples.values.len(), channel.unit.name),
        (1000, "g")
    );
    assert_eq!(channel.samples.values[0], -0.2095313E-01 * 9.80665);
    assert_eq!(channel.samples.dt(), Some(0.005));
}

/// The last header line as found in files, with the same values below.
#[test]
fn at2_header_lines() {
    let text = String::from_utf8(AT2.to_vec()).expect("ASCII");
    let expected = samples(AT2);
    let now = "NPTS=   1000, DT=   .0050 SEC";
    assert!(text.contains(now));
    for line in [
        "1000    0.0050    NPTS, DT",
        "  1000 .0050 NPTS, DT ",
        "NPTS=1000,DT=0.005SEC",
        "NPTS=  1000, DT= .00500 SEC",
        "NPTS=   1000, dt=  .00500",
        "NPTS=   1000, DT=   .0050 SEC,                    ",
        "NPTS=   1000, DT=    5.0E-3 SEC",
        "npts=   1000, dt=   .0050 sec",
        "NPTS: 1000 DT: 0.005",
    ] {
        assert_eq!(
            samples(text.replace(now, line).as_bytes()),
            expected,
            "{line}"
        );
    }
    let longer = text.replace(
        now,
        "one more line, 3\nand another 4.5\nand a third\nNPTS= 1000, DT= .005",
    );
    assert_eq!(
        samples(longer.as_bytes()),
        expected,
        "seven lines of header"
    );
    let closed = format!("{text}*** End data ***\n");
    assert_eq!(samples(closed.as_bytes()), expected, "a closing line");
}

#[test]
fn at2_units() {
    let text = String::from_utf8(AT2.to_vec()).expect("ASCII");
    let line = "ACCELERATION TIME SERIES IN UNITS OF G";
    for (stated, name) in [
        (
            "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.4 Hz LP=23.0 Hz",
            "g",
        ),
        ("The units are (g)", "g"),
        ("Acceleration in g", "g"),
        ("ACCELERATION TIME SERIES IN UNITS OF CM/SEC/SEC", "cm/s^2"),
        ("ACCELERATION TIME SERIES IN UNITS OF M/S**2", "m/s^2"),
    ] {
        let channel = channel(text.replace(line, stated).as_bytes());
        assert_eq!(channel.unit.name, name, "{stated}");
    }
    let silent = text.replace(line, "nothing");
    let (at, fault) = open(silent.as_bytes(), &Given::default()).expect_err("no unit");
    assert_eq!(at, 3);
    assert!(fault.help.contains("`unit`"), "{fault}");
    let given = Given {
        unit: Unit::parse("g"),
        dt: None,
    };
    assert!(open(silent.as_bytes(), &given).is_ok());
    let given = Given {
        unit: Unit::parse("m/s2"),
        dt: None,
    };
    let (at, fault) = open(AT2, &given).expect_err("a contradiction");
    assert_eq!(at, 3);
    assert!(
        fault.message.contains("states the unit g, not m/s^2"),
        "{fault}"
    );
    let given = Given {
        unit: None,
        dt: Some(0.01),
    };
    assert_eq!(open(AT2, &given).expect_err("a contradiction").0, 4);
}

/// Counts keep their offset; the peak of the header is of values without their mean.
#[test]
fn knet_counts() {
    for (bytes, format, name) in [
        (KNET, Format::KNet, "E-W"),
        (KIKNET, Format::KikNet, "EW surface"),
    ] {
        let motion = open(bytes, &Given::default()).expect("a record");
        assert_eq!((motion.format, &*motion.channels[0].name), (format, name));
        assert!(
            motion.notes.iter().all(|note| !note.doubt),
            "{:?}",
            motion.notes
        );
        let raw = &motion.channels[0].samples;
        assert_eq!((raw.values.len(), raw.dt()), (2000, Some(0.005)));
        assert_near(raw.values[0], 0.047538890796522786, 1e-14, "first value");
        assert_near(raw.values[4], 3.804125697241087e-05, 1e-14, "fifth value");
        let m = Measures::of(&raw.without_mean());
        assert_near(m.pga.value, 0.6286908653916915, 1e-12, "peak");
    }
}

#[test]
fn esm() {
    let samples = samples(ESM);
    let m = Measures::of(&samples);
    assert_eq!((samples.values.len(), samples.dt()), (2000, Some(0.005)));
    assert_near(m.pga.value, 0.6232, 1e-14, "peak");
    assert_eq!(m.pga.t, 9.27);
}

#[test]
fn cesmd_channels_of_different_lengths() {
    let motion = open(cesmd().as_bytes(), &Given::default()).expect("a record");
    assert_eq!(motion.notes, []);
    let names: Vec<_> = motion
        .channels
        .iter()
        .map(|c| (&*c.name, c.samples.values.len()))
        .collect();
    assert_eq!(names, [("360 Deg", 400), ("Up", 397), ("90 Deg", 400)]);
    let first = &motion.channels[0].samples;
    assert_eq!(first.dt(), Some(0.005));
    let m = Measures::of(first);
    assert_near(m.pga.value, 1.0441, 1e-14, "peak");
    assert_near(m.pga.t, 10.17 - 9.5, 1e-12, "its time");
    // Older files write other words, and some state no format.
    let old = cesmd()
        .to_uppercase()
        .replace("IN CM/SEC2.  (8F10.4)", "(UNITS: CM/SEC/SEC)  ");
    let again = open(old.as_bytes(), &Given::default()).expect("a record");
    assert_eq!(again.channels[2].samples, motion.channels[2].samples);
}

#[test]
fn columns_in_every_style() {
    let found = Found {
        points: 2000,
        dt: 0.005,
        pga: 0.6232,
        t: 9.27,
        mean: -0.005492618508,
        pgv: -0.05554683313,
        arias: 0.022613692227331082,
    };
    assert_found(
        &samples(record_file!("semicolon_decimal_comma.csv")),
        &found,
    );
    let one = samples(record_file!("acc_g_onecolumn.txt"));
    let found = Found {
        pga: 0.62320000007076,
        mean: -0.005492618506133169,
        pgv: -0.05554683311344194,
        arias: 0.022613692225289746,
        ..found
    };
    assert_found(&one, &found);
}

#[test]
fn rounded_times_have_one_step() {
    let rounded = samples(record_file!("rounded_times.csv"));
    assert_eq!((rounded.dt(), rounded.values.len()), (Some(0.02), 500));
    let third = open(record_file!("rounded_times_third.csv"), &Given::default()).expect("a record");
    assert_eq!(third.channels[0].samples.dt(), Some(1.0 / 300.0));
    assert!(
        third.notes[0].message.contains("1/300"),
        "{:?}",
        third.notes
    );
    assert_eq!(samples(RAMP).dt(), Some(0.05));
}

#[test]
fn unequal_times_are_kept() {
    let motion = open(record_file!("nonuniform_times.csv"), &Given::default()).expect("a record");
    let samples = &motion.channels[0].samples;
    let Times::At(times) = &samples.times else {
        panic!("not one step")
    };
    assert_eq!((times.len(), times[399]), (400, 4.296339));
    let m = Measures::of(samples);
    assert_near(m.arias, 0.001666364389396769, 1e-12, "arias");
    assert_near(m.pgv.value.abs(), 0.01844884005325, 1e-12, "pgv");
    assert_near(m.end[0], 0.00079202330139, 1e-10, "velocity at the end");
    assert!(
        motion.notes[0].message.contains("not equal"),
        "{:?}",
        motion.notes
    );
}

/// Names, comments and separators, all of the same three values.
#[test]
fn units_and_steps_are_found_where_they_are_stated() {
    for text in [
        "time_s,acc_m_s2\n0,1\n0.5,2\n1.0,3\n",
        "t [s];a [m/s²]\n0;1\n0,5;2\n1,0;3\n",
        "Time (sec)\tAcceleration (m/s^2)\n0.0\t1\n0.5\t2\n1.0\t3\n",
        "time, s | acc, m/s2\n0.0|1\n0.5|2\n1.0|3\n",
        "t_s  acc_m_s2\n0.0  1\n0.5  2\n1.0  3\n",
        "t [s]  acc [m/s2]\n0.0  1\n0.5  2\n1.0  3\n",
        "t,a\ns,m/s2\n0.0,1\n0.5,2\n1.0,3\n",
        "# time_s acc_m_s2\n0.0 1\n0.5 2\n1.0 3\n",
        "# dt = 0.5 s, acceleration in m/s^2\n1\n2\n3\n",
        "% units: m/s2\n% sampling rate = 2 Hz\n1\n2\n3\n",
        "# time step: 500 ms\nacc [m/s2]\n1\n2\n3\n",
        "# [m/s2]\n# dt = 0.5 s\n1\n2\n3\n",
        "# record of the shelf [cm/s^2], dt [s] = 0.5\n# dt = 0.5\n100\n200\n300\n",
        "# acceleration in cm/s2, dt = 0.5\n100\n200\n300\n",
        "# units m/s2, dt 0.5 s; low-cut frequency = 0.1 Hz, peak acceleration = 0.3 g\n1\n2\n3\n",
        "# step = 500 ms, filter step 7\nacc_mps2\n1\n2\n3\n",
        "time_s acc_m_s2 quality[flag]\n0.0 1 9\n0.5 2 9\n1.0 3 9\n",
        "# dt=0.5\nacceleration_gal\n100\n200\n300\n",
        "# dt = 0.5 s\na [m/s2]\n1,0\n2,0\n3,0\n",
        "t_ms;a_mm_s2\n0;1000\n500;2000\n1000;3000\n",
        "\"time_s\",\"acc_m_s2\"\n\"0.0\",\"1\"\n\"0.5\",\"2\"\n\"1.0\",\"3\"\n",
        "time_s,acc_m_s2,\n0.0,1,\n0.5,2,\n1.0,3,\n",
        "0.0,1\n0.5,2\n1.0,3\n# columns: time_s, acc_m_s2\n",
        "time_s vel_m_s acc_m_s2\n0.0 9 1\n0.5 9 2\n1.0 9 3\n",
    ] {
        let motion =
            open(text.as_bytes(), &Given::default()).unwrap_or_else(|f| panic!("{text}: {f:?}"));
        assert_eq!(motion.channels.len(), 1, "{text}");
        assert!(
            motion.notes.iter().all(|n| !n.doubt),
            "{text}: {:?}",
            motion.notes
        );
        let samples = &motion.channels[0].samples;
        assert_eq!(
            (samples.dt(), &samples.values[..]),
            (Some(0.5), &[1.0, 2.0, 3.0][..]),
            "{text}"
        );
    }
}

#[test]
fn what_is_not_stated_is_asked_for() {
    let asked = [
        ("1\n2\n3\n", "`dt`"),
        ("# dt = 0.5\n1\n2\n3\n", "`unit`"),
        ("acc_m_s2\n1\n2\n3\n", "`dt`"),
        ("time_s,acc\n0.0,1\n0.5,2\n", "`unit`"),
        ("x,y\n0.0,1\n0.5,2\n", "`dt`"),
    ];
    for (text, key) in asked {
        let (_, fault) = open(text.as_bytes(), &Given::default()).expect_err(text);
        assert!(fault.help.contains(key), "{text}: {fault}");
    }
    let given = Given {
        unit: Unit::parse("m/s^2"),
        dt: Some(0.5),
    };
    for (text, _) in &asked[..4] {
        let motion = open(text.as_bytes(), &given).unwrap_or_else(|f| panic!("{text}: {f:?}"));
        assert_eq!(motion.channels[0].samples.dt(), Some(0.5), "{text}");
    }
    // Seconds are meant, but nobody says so.
    let given = Given {
        unit: Unit::parse("m/s^2"),
        dt: None,
    };
    let motion = open(b"time,acc\n0.0,1\n0.5,2\n1.0,3\n", &given).expect("a record");
    assert!(motion.notes[0].doubt && motion.notes[0].message.contains("seconds"));
    let contrary = b"# acceleration in g\ntime_s,acc_m_s2\n0.0,1\n0.5,2\n";
    let motion = open(contrary, &Given::default()).expect("a record");
    assert!(motion.notes[0].doubt && motion.notes[0].message.contains("another unit"));
    let given = Given {
        unit: Unit::parse("m/s^2"),
        dt: Some(0.25),
    };
    assert!(open(b"time,acc\n0.0,1\n0.5,2\n1.0,3\n", &given).is_err());
}

#[test]
fn several_columns_are_several_channels() {
    let text = b"t_s,ns_g,ew_g,ud_g\n0.0,1,2,3\n0.01,4,5,6\n";
    let motion = open(text, &Given::default()).expect("a record");
    let names: Vec<_> = motion.channels.iter().map(|c| &*c.name).collect();
    assert_eq!(names, ["ns", "ew", "ud"]);
    assert_eq!(
        motion.channels[2].samples.values,
        [3.0 * 9.80665, 6.0 * 9.80665]
    );
}

/// A file is of one format only.
#[test]
fn every_detector_knows_its_own_files_alone() {
    let built = cesmd();
    let files: [(&str, &[u8]); 15] = [
        ("at2", AT2),
        ("smc", SMC),
        ("smc", record_file!("0165a_u.smc")),
        ("cosmos", COSMOS),
        ("knet", KNET),
        ("knet", KIKNET),
        ("esm", ESM),
        ("cesmd", built.as_bytes()),
        ("csv", RAMP),
        ("csv", record_file!("sine.csv")),
        ("csv", record_file!("acc_g_onecolumn.txt")),
        ("csv", record_file!("nonuniform_times.csv")),
        ("csv", record_file!("rounded_times.csv")),
        ("csv", record_file!("rounded_times_third.csv")),
        ("csv", record_file!("semicolon_decimal_comma.csv")),
    ];
    for (i, (own, bytes)) in files.iter().enumerate() {
        let text = decode(bytes).expect("a text");
        let page = Page::new(&text);
        let known: Vec<_> = READERS
            .iter()
            .filter(|(_, detect, _)| detect(&page))
            .map(|r| r.0)
            .collect();
        assert_eq!(known, [*own], "file {i}");
    }
}
