//! Trajectories as CSV, to stdout or to a file that has its name only when it is whole.

use std::io::{self, BufWriter, Stdout, Write};
use std::path::Path;

use carom_dynamics::{BodyId, BodyKind, World};
use carom_render::Draft;
use carom_scenes::Built;

use crate::exit::Failure;
use crate::field::field;
use crate::files;
use crate::out::is_closed_pipe;

const HEADING: &str = "time,body,x,y,angle,vx,vy,omega";

/// An open table.
pub(super) struct Table {
    target: Target,
    /// The bodies that can move, by their names.
    bodies: Vec<(String, BodyId)>,
    started: bool,
    /// Where it goes, for an error.
    place: String,
}

enum Target {
    Stdout(BufWriter<Stdout>),
    File(Draft),
}

impl Table {
    /// A table of the moving bodies at `place`, or on stdout.
    pub(super) fn open(place: Option<&Path>, built: &Built) -> Result<Self, Failure> {
        let target = match place {
            None => Target::Stdout(BufWriter::new(io::stdout())),
            Some(place) => Target::File(Draft::create(files::prepare(place)?)?),
        };
        let moves = |id: BodyId| {
            built
                .world
                .body(id)
                .is_some_and(|body| body.kind() != BodyKind::Fixed)
        };
        let bodies = built.names.iter().filter(|(_, id)| moves(*id));
        Ok(Self {
            target,
            bodies: bodies.map(|(name, id)| (field(name), *id)).collect(),
            started: false,
            place: place.map_or_else(|| "stdout".to_owned(), |place| place.display().to_string()),
        })
    }

    /// A row for each body that can move; `false` if the reader of stdout went away.
    pub(super) fn write(&mut self, world: &World) -> Result<bool, Failure> {
        match self.try_write(world) {
            Ok(()) => Ok(true),
            Err(error) if is_closed_pipe(&error) => Ok(false),
            Err(error) => Err(Failure::new(format!(
                "cannot write the trajectories to {}: {error}",
                self.place
            ))),
        }
    }

    fn try_write(&mut self, world: &World) -> io::Result<()> {
        let writer: &mut dyn Write = match &mut self.target {
            Target::Stdout(writer) => writer,
            Target::File(draft) => draft,
        };
        if !self.started {
            writeln!(writer, "{HEADING}")?;
            self.started = true;
        }
        let time = world.time().as_secs();
        for (name, id) in &self.bodies {
            let Some(body) = world.body(*id) else {
                continue;
            };
            let (centre, velocity) = (body.centre(), body.velocity());
            // Debug writes the shortest decimal that reads back as the same double, with an exponent where it is long.
            writeln!(
                writer,
                "{time:?},{name},{:?},{:?},{:?},{:?},{:?},{:?}",
                centre.x,
                centre.y,
                body.angle(),
                velocity.x,
                velocity.y,
                body.angular_velocity()
            )?;
        }
        Ok(())
    }

    /// Flushes the table and gives its file the name.
    pub(super) fn finish(self) -> Result<(), Failure> {
        match self.target {
            Target::Stdout(mut writer) => match writer.flush() {
                Err(error) if !is_closed_pipe(&error) => Err(error.into()),
                _ => Ok(()),
            },
            Target::File(draft) => Ok(draft.finish()?),
        }
    }
}
