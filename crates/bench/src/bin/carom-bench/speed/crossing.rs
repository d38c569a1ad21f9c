//! At how many impacts of a body in a second the exact method costs as much as sub-steps do.

use std::fmt::Write as _;

use carom_bench::{EngineName, Mode};

use super::row::SpeedRow;
use crate::head::Head;
use crate::text;

/// Spacings of the gases, in mm, from thin to dense: the largest bodies are 1.1 m wide.
const SPACINGS: [u32; 9] = [5200, 3900, 2600, 1950, 1560, 1300, 1240, 1190, 1150];

/// The gases by name, from thin to dense.
pub(super) fn scenes() -> Vec<String> {
    SPACINGS
        .iter()
        .map(|spacing| format!("gas_spaced_{spacing}"))
        .collect()
}

/// Head, a table for each peer, and where its time equals carom's.
pub(super) fn markdown(head: &Head, rows: &[SpeedRow]) -> String {
    let mut text = String::from("# How many impacts the exact method affords\n\n");
    text += &head.markdown();
    text += "\n1,024 elastic bodies of scene e in closed boxes, ever denser. Impacts: of a body in a second, as carom counts them one by one. \
             ms: mean CPU time of a step of 1/60 s on one thread, defaults. Energy: after the measured steps over before them; it should stay. \
             Overlap: the deepest at the end, in m.\n";
    let mut peers: Vec<EngineName> = rows.iter().map(|row| row.engine).collect();
    peers.sort();
    peers.dedup();
    for peer in peers {
        if peer != EngineName::Carom {
            compare(&mut text, rows, peer);
        }
    }
    text
}

fn compare(text: &mut String, rows: &[SpeedRow], peer: EngineName) {
    let _ = write!(
        text,
        "\n## carom and {peer}\n\n| spacing mm | impacts | carom ms | energy | overlap | {peer} ms | energy | overlap | ratio |\n|{}\n",
        "---|".repeat(9)
    );
    let mut points = Vec::new();
    for (name, spacing) in scenes().iter().zip(SPACINGS) {
        let find = |engine: EngineName| {
            let mode: Mode = engine.modes()[0];
            let same = |row: &&SpeedRow| {
                row.scene == *name && row.engine == engine && row.mode == mode && !row.reads_poses
            };
            rows.iter().find(same)
        };
        let (Some(own), Some(other)) = (find(EngineName::Carom), find(peer)) else {
            continue;
        };
        let ratio = own.ms_mean.zip(other.ms_mean).map(|(a, b)| a / b);
        points.extend(own.impact_rate.zip(ratio));
        let cells = [
            spacing.to_string(),
            text::number(own.impact_rate),
            text::number(own.ms_mean),
            text::ratio(own.energy_ratio),
            text::error(own.overlap_max),
            text::number(other.ms_mean),
            text::ratio(other.energy_ratio),
            text::error(other.overlap_max),
            text::number(ratio),
        ];
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    let _ = writeln!(text, "\n{}", verdict(&mut points));
}

/// Where the ratio is 1, in words.
fn verdict(points: &mut [(f64, f64)]) -> String {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return "No gas was measured with both.".to_owned();
    };
    if let Some(rate) = crossing(points) {
        return format!("Equal at {rate:.1} impacts of a body in a second.");
    }
    if last.1 < 1.0 {
        let cheapest = "The exact method is the cheaper one in every gas";
        return format!("{cheapest}, up to {:.1} impacts.", last.0);
    }
    let dearest = "The exact method is the dearer one in every gas";
    format!("{dearest}, down to {:.2} impacts.", first.0)
}

/// The first rate at which the ratio rises through 1, between two gases by logarithms: the cost of an impact is one number,
/// so that the ratio is nearly a power of their rate.
fn crossing(points: &[(f64, f64)]) -> Option<f64> {
    points.windows(2).find_map(|pair| {
        let [(x, below), (y, above)] = [pair[0], pair[1]];
        if !(below <= 1.0 && above > 1.0) {
            return None;
        }
        let log = carom_math::trig::ln;
        let share = -log(below) / (log(above) - log(below));
        Some(carom_math::trig::exp(log(x) + share * (log(y) - log(x))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::speed::row::tests::some;

    #[test]
    fn a_ratio_that_grows_with_the_rate_is_one_where_it_should_be() {
        // ratio = rate / 12
        let line: Vec<(f64, f64)> = [2.0, 5.0, 10.0, 20.0].map(|x| (x, x / 12.0)).to_vec();
        assert!((crossing(&line).unwrap() - 12.0).abs() < 1e-12);
        assert_eq!(crossing(&line[..3]), None);
        let said = verdict(&mut line.clone());
        assert_eq!(said, "Equal at 12.0 impacts of a body in a second.");
        let cheap = verdict(&mut line[..3].to_vec());
        assert!(
            cheap.contains("cheaper one in every gas, up to 10.0"),
            "{cheap}"
        );
    }

    #[test]
    fn every_gas_is_a_line_of_every_peer() {
        let mut rows = Vec::new();
        for scene in scenes() {
            for row in some() {
                rows.push(SpeedRow {
                    scene: scene.clone(),
                    impact_rate: Some(1.0),
                    ..row
                });
            }
        }
        let text = markdown(&Head::default(), &rows);
        assert_eq!(text.matches("| 1300 |").count(), 3, "{text}");
        for scene in scenes() {
            assert!(carom_scenes::plain_scene(&scene).is_some(), "{scene}");
        }
    }
}
