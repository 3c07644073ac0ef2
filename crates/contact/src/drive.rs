//! What drives a contact.

/// What is given; the other follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Torque on gear 2 \[N·m\]: Σ b F; the transmission error follows.
    Torque(f64),
    /// Transmission error \[m\], −x; the torque follows.
    TransmissionError(f64),
}
