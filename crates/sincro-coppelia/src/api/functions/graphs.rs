//! Functions: graphs. Values of their streams are recorded with the run; curves, colours and windows are accepted and
//! show nothing.

use super::{Function, Outcome, done, handle, one};
use crate::api::{ApiError, Arguments, Handle, SimApi};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "addGraphStream",
        tip: "int streamId=sim.addGraphStream(int graphHandle,string streamName,string unit,int options=0,float[3] color={1,0,0},float cyclicRange=pi)",
        run: add,
    },
    Function {
        name: "setGraphStreamValue",
        tip: "sim.setGraphStreamValue(int graphHandle,int streamId,float value)",
        run: set,
    },
    Function {
        name: "setGraphStreamTransformation",
        tip: "sim.setGraphStreamTransformation(int graphHandle,int streamId,int transformationType,float mult=1.0,float off=0.0,int movAvgPeriod=1)",
        run: transform,
    },
    Function {
        name: "setGraphUserData",
        tip: "int result=sim.setGraphUserData(int graphHandle,string dataStreamName,float data)",
        run: set_named,
    },
    Function { name: "resetGraph", tip: "int result=sim.resetGraph(int objectHandle)", run: reset },
    Function {
        name: "handleGraph",
        tip: "int result=sim.handleGraph(int objectHandle,float simulationTime)",
        run: sample,
    },
    Function {
        name: "addGraphCurve",
        tip: "int curveId=sim.addGraphCurve(int graphHandle,string curveName,int dim,int[2..3] streamIds,float[2..3] defaultValues,string unitStr,int options=0,float[3] color={1,1,0},int curveWidth=2)",
        run: curve,
    },
    Function {
        name: "destroyGraphCurve",
        tip: "sim.destroyGraphCurve(int graphHandle,int curveId)",
        run: |d, a| graph(d, a).and_then(|_| done()),
    },
    Function {
        name: "duplicateGraphCurveToStatic",
        tip: "int curveId=sim.duplicateGraphCurveToStatic(int graphHandle,int curveId,string curveName='')",
        run: |d, a| graph(d, a).and_then(|_| one(1_i64)),
    },
];

fn graph(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Handle, ApiError> {
    handle(sim, a, 0)
}

fn add(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = graph(sim, a)?;
    // some scripts give a number for the unit: it then has none
    let unit = a.get(2).as_text().unwrap_or_default();
    one(sim.add_stream(own, a.text(1)?, unit)?)
}

fn set(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = graph(sim, a)?;
    sim.set_stream(own, a.int(1)?, a.real(2)?)?;
    done()
}

/// Values as they are, multiplied and shifted; derivatives, integrals and means are made of the recorded signals
/// afterwards.
fn transform(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = graph(sim, a)?;
    if a.int(2)? != 0 || a.int_or(5, 1)? > 1 {
        return Err(ApiError::new(
            "values are recorded as they are (transformation 0, a mean over 1): derivatives and means are made of signals.csv",
        ));
    }
    let real_or = |k: usize, default: f64| if a.has(k) { a.real(k) } else { Ok(default) };
    sim.scale_stream(own, a.int(1)?, (real_or(3, 1.0)?, real_or(4, 0.0)?))?;
    done()
}

/// V-REP's: a stream is made by its first value.
fn set_named(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = graph(sim, a)?;
    let value = a.real(2)?;
    let stream = sim.add_stream(own, a.text(1)?, "")?;
    sim.set_stream(own, stream, value)?;
    one(1_i64)
}

/// The graph of a handle; none for all of them.
fn one_or_all(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Option<Handle>, ApiError> {
    if matches!(a.handle(0)?, -2 | -3) { Ok(None) } else { graph(sim, a).map(Some) }
}

fn reset(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = one_or_all(sim, a)?;
    sim.clear_graph(own)?;
    one(1_i64)
}

/// Streams are recorded at every row of the run, asked or not.
fn sample(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    one_or_all(sim, a)?;
    one(1_i64)
}

fn curve(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    graph(sim, a)?;
    a.text(1)?;
    one(1_i64)
}
