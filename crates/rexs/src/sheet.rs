//! What a scene must show when it runs: shafts and their speeds, where power goes in and out, what holds each train.
//! For whoever runs the scene and compares.

use crate::drive_text::Held;
use crate::gearbox::Train;
use std::collections::HashMap;

/// A place where power goes in or out.
#[derive(Debug, Clone)]
pub struct Port {
    /// The load.
    pub name: String,
    /// Its shaft.
    pub shaft: String,
    /// Torque about z \[N m\].
    pub torque_nm: f64,
    /// Speed about z \[1/min\].
    pub speed_rpm: f64,
    /// The spring of the scene that stands in its place; none where the torque is a load.
    pub spring: Option<String>,
}

/// A scene's figures by the ratios.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// File of the scene.
    pub scene: String,
    /// Shafts and their speeds about z \[1/min\]; without loose gears.
    pub shafts: Vec<(String, f64)>,
    /// Loads that transmit torque.
    pub ports: Vec<Port>,
    /// What holds the trains.
    pub held: Vec<Held>,
    /// Gear meshes.
    pub meshes: Vec<String>,
    /// Bearings.
    pub bearings: Vec<String>,
    /// Bodies of the scene: gears, and stations of shafts.
    pub bodies: usize,
}

impl Sheet {
    /// The figures of a train.
    pub fn new(scene: &str, train: &Train, held: Vec<Held>) -> Self {
        let speed = |id: i64| train.flow.speed_rpm.get(&id).copied().unwrap_or(0.0);
        let name = |id: i64| train.shaft(id).map_or("", |s| &s.name).to_owned();
        let shafts = || train.shafts.iter().filter(|s| s.hub_on.is_none());
        let mut spring_at: HashMap<&str, &str> = HashMap::new();
        for h in &held {
            spring_at.entry(&h.at).or_insert(&h.spring);
        }
        let transmitting = train.loads.iter().filter(|l| l.transmits);
        let ports = transmitting
            .zip(&train.flow.torque_nm)
            .map(|(load, &torque_nm)| Port {
                name: load.name.clone(),
                shaft: name(load.shaft),
                torque_nm,
                speed_rpm: speed(load.shaft),
                spring: spring_at.get(&*load.name).map(|&spring| spring.to_owned()),
            });
        let ports = ports.collect();
        Self {
            scene: scene.to_owned(),
            ports,
            shafts: shafts().map(|s| (s.name.clone(), speed(s.id))).collect(),
            bodies: train.gears.len() + shafts().map(|s| s.stations_mm().len()).sum::<usize>(),
            meshes: train.meshes.iter().map(|m| m.name.clone()).collect(),
            bearings: train.bearings.iter().map(|b| b.name.clone()).collect(),
            held,
        }
    }
}
