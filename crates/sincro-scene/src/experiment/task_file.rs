//! The table `[task]` of the experiment file as it is written. Doc comments here become the descriptions in the JSON
//! Schema.

use std::collections::BTreeMap;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

/// A task for reinforcement learning: observations, actions, reward and end of an episode.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct TaskFile {
    /// Time from one action to the next: a whole number of base steps; one base step if left out [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub period: Option<f64>,
    /// Longest episode, after which it is truncated: the experiment's duration if left out [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub time_limit: Option<f64>,
    /// Short names of signals, for the formulas.
    #[serde(default)]
    pub signals: BTreeMap<String, String>,
    /// Observations of the agent: formulas of the short names, the actions, the random numbers, `t` and the parameters.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub observations: Vec<String>,
    /// Reward of each action's period: a formula at its end.
    pub reward: String,
    /// The episode has come to its end, such as a fall: a formula, true where it is not zero.
    pub terminated: Option<String>,
    /// Actions of the agent.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub action: Vec<ActionFile>,
    /// Commands by formulas of the actions, where an action is no command itself.
    #[serde(default)]
    pub commands: BTreeMap<String, String>,
    /// Numbers that are drawn anew for each episode.
    #[serde(default)]
    pub random: Vec<RandomFile>,
}

/// One action.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["range"]}, {"required": ["values"]}])))]
pub(crate) struct ActionFile {
    /// Its name in formulas.
    pub name: String,
    /// The command that it is, such as `/rail`: a motor, a rotor, a component of a force; none if `commands` make
    /// something of it.
    pub command: Option<String>,
    /// Least and greatest value; what is beyond is brought to the bound.
    pub range: Option<[f64; 2]>,
    /// The values that it can have, chosen by number.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub values: Option<Vec<f64>>,
}

/// A number that is drawn anew for each episode.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("allOf" = [
    {"oneOf": [{"required": ["name"]}, {"required": ["signal"]}, {"required": ["path"]}]},
    {"oneOf": [{"required": ["range"]}, {"required": ["normal"]}]}
])))]
pub(crate) struct RandomFile {
    /// Its name in formulas: a goal, say.
    pub name: Option<String>,
    /// The coordinate or velocity that starts with it, such as `/hinge.position`.
    pub signal: Option<String>,
    /// The number of the scene or the diagram that has it, a path as for `--set`.
    pub path: Option<String>,
    /// Uniform between two bounds.
    pub range: Option<[f64; 2]>,
    /// Normal: mean and standard deviation.
    pub normal: Option<[f64; 2]>,
}
