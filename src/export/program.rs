use std::vec;
use std::vec::Vec;

use crate::composed::Spec;
use crate::dynamics::{Interval, Part, State};
use crate::error::ModelError;
use crate::graph::{self, Format, Id, Operation, Recorder};
use crate::table::Channel;

/// The column of the time step; those before are channels, those behind numbers of the state.
const TIME_STEP: usize = Channel::ALL.len();

/// A step of a model: from state and sample to torque and state.
#[derive(Clone, Debug)]
pub struct Program {
    /// What is computed, in an order in which it can be; no more than is needed.
    pub operations: Vec<Operation>,
    /// The operation that yields the torque at the end of the step (T).
    pub torque: Id,
    /// The numbers of the state that the torque, now or later, depends on. All start at 0.
    pub states: Vec<StateNumber>,
}

/// A number of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateNumber {
    /// Which.
    pub part: Part,
    /// The operation that yields it at the end of the step.
    pub after: Id,
}

/// What a column of a [`Program`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A channel of the sample.
    Channel(Channel),
    /// Length of the step (s).
    TimeStep,
    /// A number of the state before the step, by its place among [`Program::states`].
    State(usize),
}

impl Program {
    /// The step of a model, in the precision `F`: what is known beforehand is computed in it. A
    /// delay, which shifts whole recordings, is no part of it.
    ///
    /// # Errors
    /// A formula that is larger than a formula can be.
    pub fn of<F: Format>(spec: &Spec) -> Result<Self, ModelError<'static>> {
        let recorder = Recorder::default();
        let number = |operation| recorder.number::<F>(operation);
        let (model, sample) = graph::model::<F>(&recorder, spec)?;
        let mut parts = vec![];
        let mut state = State::default().map(|part, _| {
            parts.push(part);
            number(Operation::Column(TIME_STEP + parts.len()))
        });
        let dt = number(Operation::Column(TIME_STEP));
        let torque = recorder.id(model.over(&mut state, &Interval::held(sample, dt)).torque);
        let mut states = vec![];
        let _ = state.map(|part, number| {
            states.push(StateNumber { part, after: recorder.id(number) });
            number
        });
        Ok(Self { operations: recorder.operations(), torque, states }.pruned())
    }

    /// What a column is.
    #[must_use]
    pub fn input(column: usize) -> Input {
        match Channel::ALL.get(column) {
            Some(&channel) => Input::Channel(channel),
            None if column == TIME_STEP => Input::TimeStep,
            None => Input::State(column - TIME_STEP - 1),
        }
    }

    /// Without what the torque never depends on.
    fn pruned(self) -> Self {
        let mut needed = vec![false; self.operations.len()];
        let mut held = vec![false; self.states.len()];
        let mut open = vec![self.torque];
        while let Some(id) = open.pop() {
            if core::mem::replace(&mut needed[id], true) {
                continue;
            }
            open.extend(self.operations[id].operands());
            if let Operation::Column(column) = self.operations[id]
                && let Input::State(place) = Self::input(column)
            {
                held[place] = true;
                open.push(self.states[place].after);
            }
        }
        let renumber = |kept: &[bool]| {
            kept.iter()
                .scan(0, |next, &kept| Some(core::mem::replace(next, *next + usize::from(kept))))
                .collect::<Vec<usize>>()
        };
        let (place, number) = (renumber(&needed), renumber(&held));
        let columns = |column| match Self::input(column) {
            Input::State(state) => TIME_STEP + 1 + number[state],
            _ => column,
        };
        let kept = self.operations.iter().zip(&needed).filter(|(_, needed)| **needed);
        let states = self.states.iter().zip(&held).filter(|(_, held)| **held);
        Self {
            operations: kept
                .map(|(operation, _)| operation.moved(|id| place[id], columns))
                .collect(),
            torque: place[self.torque],
            states: states
                .map(|(own, _)| StateNumber { after: place[own.after], ..*own })
                .collect(),
        }
    }
}
