//! Stepped mode on what has broken other engines: one test a case, by its number in the list of failures.

mod rests;
mod strikes;

use carom_dynamics::Settings;
use carom_math::Vec2;

const G: f64 = 9.81;

fn weightless() -> Settings {
    Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    }
}

fn restless(settings: Settings) -> Settings {
    Settings {
        sleep: None,
        ..settings
    }
}
