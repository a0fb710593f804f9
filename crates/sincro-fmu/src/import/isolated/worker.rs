//! The side of the process: one instance, asked over the connection in the place of standard input.

use std::io::{self, Read, Write};

use sincro_scene::fmu::{FmuEvents, FmuInstance, FmuInterface, FmuModel};

use super::super::ForeignFmu;
use super::super::block::Model;
use super::wire::{Fields, Frame, Verb};

/// Largest number of numbers that is asked for at once.
const MAX_NUMBERS: usize = 100_000_000;

/// Serves one instance of an FMU until the connection in the place of standard input ends: the process of
/// [`IsolatedLoader`](super::IsolatedLoader).
///
/// # Errors
///
/// Standard input is no connection, or it breaks.
#[cfg(unix)]
pub fn serve() -> io::Result<()> {
    use std::os::fd::AsFd;
    let connection = io::stdin().as_fd().try_clone_to_owned()?;
    let mut reader = std::os::unix::net::UnixStream::from(connection);
    let mut writer = reader.try_clone()?;
    answer(&mut reader, &mut writer)
}

/// Serves nothing: other systems have no pair of sockets without a name.
///
/// # Errors
///
/// Always.
#[cfg(not(unix))]
pub fn serve() -> io::Result<()> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "FMUs run in processes of their own on Unix alone"))
}

/// Answers until the end of the connection.
fn answer(reader: &mut impl Read, writer: &mut impl Write) -> io::Result<()> {
    let mut instance: Option<Box<dyn FmuInstance>> = None;
    while let Some(mut fields) = Frame::receive(reader)? {
        let verb = fields.code().ok().and_then(|code| Verb::ALL.get(usize::from(code)).copied());
        let done = match (verb, &mut instance) {
            (None, _) => Err("an unknown message".to_owned()),
            (Some(Verb::Open), _) => open(fields).map(|new| {
                instance = Some(new);
                Fields::default().code(0)
            }),
            (Some(_), None) => Err("there is no instance yet".to_owned()),
            (Some(verb), Some(instance)) => act(&mut **instance, verb, fields),
        };
        let fields = done.unwrap_or_else(|message| Fields::default().code(1).bytes(message.as_bytes()));
        fields.send(writer)?;
    }
    Ok(())
}

fn open(mut fields: Frame) -> Result<Box<dyn FmuInstance>, String> {
    let fmu = ForeignFmu::read(fields.bytes()?)?;
    let code = fields.code()?;
    let kinds = [FmuInterface::CoSimulation, FmuInterface::ModelExchange, FmuInterface::ScheduledExecution];
    let interface = kinds.into_iter().find(|kind| *kind as u8 == code).ok_or("an unknown interface")?;
    let places = fields.places()?;
    let parameters = places.into_iter().map(|k| Ok((k, fields.numbers()?))).collect::<Result<Vec<_>, String>>()?;
    Model::new(fmu).instantiate(interface, &parameters)
}

fn act(instance: &mut dyn FmuInstance, verb: Verb, mut fields: Frame) -> Result<Fields, String> {
    let done = Fields::default().code(0);
    Ok(match verb {
        Verb::Open => unreachable!("answered before"),
        Verb::Start => {
            let (t, places, values) = (one(&mut fields)?, fields.places()?, fields.numbers()?);
            with_events(done, instance.start(t, (&places, &values))?)
        }
        Verb::Set => {
            let (places, values) = (fields.places()?, fields.numbers()?);
            instance.set((&places, &values))?;
            done
        }
        Verb::Get => {
            let (places, mut values) = (fields.places()?, zeros(&mut fields)?);
            instance.get(&places, &mut values)?;
            done.numbers(&values)
        }
        Verb::Step => {
            let mut times = [0.0; 2];
            fields.fill(&mut times)?;
            instance.step(times[0], times[1])?;
            done
        }
        Verb::Save => done.bytes(&instance.save()?),
        Verb::Restore => {
            instance.restore(fields.bytes()?)?;
            done
        }
        Verb::States => {
            let mut states = zeros(&mut fields)?;
            let mut nominals = states.clone();
            instance.continuous_states(&mut states, &mut nominals)?;
            done.numbers(&states).numbers(&nominals)
        }
        Verb::SetStates => {
            let (t, states) = (one(&mut fields)?, fields.numbers()?);
            instance.set_continuous_states(t, &states)?;
            done
        }
        Verb::Derivatives => {
            let mut values = zeros(&mut fields)?;
            instance.derivatives(&mut values)?;
            done.numbers(&values)
        }
        Verb::Indicators => {
            let mut values = zeros(&mut fields)?;
            instance.event_indicators(&mut values)?;
            done.numbers(&values)
        }
        Verb::CompleteStep => done.code(u8::from(instance.complete_step()?)),
        Verb::HandleEvents => {
            let (places, values) = (fields.places()?, fields.numbers()?);
            with_events(done, instance.handle_events((&places, &values))?)
        }
        Verb::DirectionalDerivative => {
            let (unknowns, knowns, seed) = (fields.places()?, fields.places()?, fields.numbers()?);
            let mut change = zeros(&mut fields)?;
            let has = instance.directional_derivative(&unknowns, &knowns, &seed, &mut change)?;
            done.code(u8::from(has)).numbers(&change)
        }
    })
}

fn with_events(fields: Fields, events: FmuEvents) -> Fields {
    fields.numbers(&[events.next]).code(u8::from(events.ends))
}

fn one(fields: &mut Frame) -> Result<f64, String> {
    let mut number = [0.0];
    fields.fill(&mut number)?;
    Ok(number[0])
}

/// As many zeros as the message asks for.
fn zeros(fields: &mut Frame) -> Result<Vec<f64>, String> {
    match fields.places()?[..] {
        [n] if n <= MAX_NUMBERS => Ok(vec![0.0; n]),
        _ => Err("a message asks for too many numbers".into()),
    }
}
