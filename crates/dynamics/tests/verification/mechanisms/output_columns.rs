//! A column that an element of docs/extending.md writes.

use std::ops::ControlFlow;

use gearmesh_dynamics::{Body, Params, Simulation, System};

use crate::mechanisms::problems::distance_sensor::DistanceSensor;

/// Two bodies that fly apart: the column is their distance in every step, and the motion is that without the sensor.
#[test]
fn a_sensor_writes_its_column_and_moves_nothing() {
    let fly = |with_sensor: bool| {
        let mut builder = System::builder();
        let bodies = [("a", [0.0, 0.0, 0.0], 1.0), ("b", [0.3, 0.4, 0.0], -2.0)].map(
            |(name, place, speed)| {
                let mut body = Body::rigid(name, 1.0, [1.0; 3]);
                body.position_m = place.into();
                body.velocity_m_per_s.x = speed;
                builder.body(body).unwrap()
            },
        );
        if with_sensor {
            builder.element(DistanceSensor { bodies });
        }
        let mut run = Simulation::new(builder.build().unwrap(), Params::fixed(1e-3)).unwrap();
        let names = run.system().channels();
        let place = names.iter().position(|(element, channel)| {
            (element.as_str(), channel.name.as_str()) == ("sensor", "distance_m")
        });
        assert_eq!(place.is_some(), with_sensor);
        let counts = vec![1; usize::from(with_sensor)];
        let mut out = vec![f64::NAN; names.len()];
        run.run(0.5, |step| {
            step.system.sample(step.to, &counts, &mut out);
            if let Some(place) = place {
                let expected = (0.3 - 3.0 * step.to.time_s).hypot(0.4);
                assert!(
                    (out[place] - expected).abs() < 1e-12,
                    "{} {expected}",
                    out[place]
                );
            }
            ControlFlow::Continue(())
        })
        .unwrap();
        let state = run.state();
        (state.positions_m.clone(), state.velocity.clone())
    };
    assert_eq!(fly(true), fly(false));
}
