//! The list of operations of one step.

use std::vec;
use std::vec::Vec;

use crate::composed::Spec;
use crate::dynamics::{Interval, Part, State};
use crate::error::ModelError;
use crate::graph::{self, Format, Id, Operation, Recorder};
use crate::table::Channel;

/// The column of the time step; channels come before it, numbers of the state after it.
const TIME_STEP: usize = Channel::ALL.len();

/// One step of a model: from state and sample to torque and state.
#[derive(Clone, Debug)]
pub struct Program {
    /// The operations, operands first; none that is not needed.
    pub operations: Vec<Operation>,
    /// The operation that computes the torque at the end of the step (T).
    pub torque: Id,
    /// The numbers of the state on which the torque depends, now or later. All start at 0.
    pub states: Vec<StateNumber>,
}

/// A number of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateNumber {
    /// The number.
    pub part: Part,
    /// The operation that computes it at the end of the step.
    pub after: Id,
}

/// The meaning of a column of a [`Program`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A channel of the sample.
    Channel(Channel),
    /// Length of the step (s).
    TimeStep,
    /// A number of the state before the step, by its index in [`Program::states`].
    State(usize),
}

impl Program {
    /// The step of a model; numbers known while recording are computed in the precision `F`. A
    /// delay, which shifts whole recordings, is not included.
    ///
    /// # Errors
    /// The formula terms exceed the largest size of a formula.
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
        let torque =
            recorder.id(model.step_over(&mut state, &Interval::constant(sample, dt)).torque);
        let mut states = vec![];
        let _ = state.map(|part, number| {
            states.push(StateNumber { part, after: recorder.id(number) });
            number
        });
        Ok(Self { operations: recorder.operations(), torque, states }.pruned())
    }

    /// The meaning of a column.
    #[must_use]
    pub fn input(column: usize) -> Input {
        match Channel::ALL.get(column) {
            Some(&channel) => Input::Channel(channel),
            None if column == TIME_STEP => Input::TimeStep,
            None => Input::State(column - TIME_STEP - 1),
        }
    }

    /// Removes operations and states that the torque never depends on.
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
