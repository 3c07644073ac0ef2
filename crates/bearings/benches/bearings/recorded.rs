//! A run with its time, and what it recorded.

use std::time::Instant;

use gearmesh_dynamics::{Params, Simulation};

use super::machine::Machine;

/// What a run took and found.
pub struct Run {
    pub steps: u64,
    pub wall_s: f64,
    /// Of the whole process, all threads.
    pub cpu_s: f64,
    pub iterations: u64,
    pub factorisations: u64,
    /// Loads of the balls at the inner race in every sample \[N\].
    pub inner_n: Vec<Vec<f64>>,
    /// Speed of the first cage about z in every sample.
    pub cage_rad_per_s: Vec<f64>,
}

impl Run {
    pub fn ball_loads(&self) -> Vec<f64> {
        self.inner_n.iter().flatten().copied().collect()
    }

    /// Mean over the second half.
    pub fn cage_speed(&self) -> f64 {
        let late = &self.cage_rad_per_s[self.cage_rad_per_s.len() / 2..];
        late.iter().sum::<f64>() / late.len() as f64
    }
}

/// Runs to an end with samples at an interval, both whole numbers of steps.
pub fn timed(machine: Machine, step_s: f64, end_s: f64, interval_s: f64) -> Run {
    let Machine { system, cages } = machine;
    let channels = system.channels();
    let elements: Vec<String> = system.elements().map(str::to_owned).collect();
    let count = |name: &String| channels.iter().filter(|(owner, _)| owner == name).count();
    let counts: Vec<usize> = elements.iter().map(count).collect();
    let inner: Vec<usize> = (0..channels.len())
        .filter(|&place| {
            let name = &channels[place].1.name;
            name.starts_with("ball_") && name.ends_with("_inner_N")
        })
        .collect();
    let mut values = vec![0.0; channels.len()];
    let (mut inner_n, mut cage_rad_per_s) = (Vec::new(), Vec::new());
    let every = (interval_s / step_s).round() as u64;
    let spin = 6 * cages[0] + 5;
    let mut simulation = Simulation::new(system, Params::fixed(step_s)).unwrap();
    let (clock, cpu) = (Instant::now(), cpu_s());
    simulation
        .run(end_s, |step| {
            if step.info.steps.is_multiple_of(every) {
                step.system.sample(step.to, &counts, &mut values);
                inner_n.push(inner.iter().map(|&place| values[place]).collect());
                cage_rad_per_s.push(step.to.velocity[spin]);
            }
            std::ops::ControlFlow::Continue(())
        })
        .unwrap();
    Run {
        wall_s: clock.elapsed().as_secs_f64(),
        cpu_s: cpu_s() - cpu,
        steps: simulation.info().steps,
        iterations: simulation.info().iterations,
        factorisations: simulation.info().factorisations,
        inner_n,
        cage_rad_per_s,
    }
}

/// The run of some that took the least processor time: that says most on a busy machine.
pub fn repeated(times: usize, machine: impl Fn() -> Machine, step_s: f64, end_s: f64) -> Run {
    let runs = (0..times).map(|_| timed(machine(), step_s, end_s, 1e-4));
    runs.min_by(|a, b| a.cpu_s.total_cmp(&b.cpu_s)).unwrap()
}

/// Processor time of this process so far, all threads, as Linux counts it; NaN elsewhere.
pub fn cpu_s() -> f64 {
    let Ok(threads) = std::fs::read_dir("/proc/self/task") else {
        return f64::NAN;
    };
    let nanoseconds = threads.flatten().filter_map(|thread| {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    1e-9 * nanoseconds.sum::<f64>()
}
