//! The server: it listens, and ends when it is asked.

use std::net::Ipv4Addr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::guard::Address;
use crate::opened::Opened;
use crate::problem::Problem;
use crate::routes::{Studio, router};

/// How often it is looked whether the server shall end.
const LOOK: Duration = Duration::from_millis(50);

/// How long connections and a calculation may take to end.
const GRACE: Duration = Duration::from_millis(1500);

/// How the server runs.
#[derive(Debug, Clone)]
pub struct ServeOptions {
    /// The port; 0 for a free one.
    pub port: u16,
    /// Once true, the server ends. A page sets it, too.
    pub stop: Arc<AtomicBool>,
}

/// Serves what was opened on 127.0.0.1 until [`ServeOptions::stop`]. `started` hears the address as soon as it answers.
///
/// # Errors
/// [`Problem`] for a port that is taken.
pub fn serve(
    opened: Opened,
    options: &ServeOptions,
    started: impl FnOnce(&str),
) -> Result<(), Problem> {
    let failed = |error: std::io::Error| Problem::Work(error.to_string());
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(failed)?;
    let outcome = runtime.block_on(async {
        let place = (Ipv4Addr::LOCALHOST, options.port);
        let taken = |error| {
            let problem = format!(
                "--port {}: {error}; choose another one, or leave it out for a free one",
                options.port
            );
            Problem::Input(problem)
        };
        let listener = tokio::net::TcpListener::bind(place).await.map_err(taken)?;
        let address = Address::new(listener.local_addr().map_err(failed)?.port())?;
        let url = address.url();
        let studio = Arc::new(Studio::new(opened, Arc::clone(&options.stop)));
        let app = router(Arc::clone(&studio), Arc::new(address));
        started(&url);
        let asked = async {
            while !studio.stop.load(Ordering::Relaxed) {
                tokio::time::sleep(LOOK).await;
            }
            studio.latest.stop();
            studio.job.stop();
        };
        let ended = async {
            asked.await;
            tokio::time::sleep(GRACE).await;
        };
        let stop = Arc::clone(&options.stop);
        let graceful = async move {
            while !stop.load(Ordering::Relaxed) {
                tokio::time::sleep(LOOK).await;
            }
        };
        let serving = axum::serve(listener, app).with_graceful_shutdown(graceful);
        // A connection that is not closed does not hold the program for longer than the grace.
        let mut serving = std::pin::pin!(serving.into_future());
        let mut ended = std::pin::pin!(ended);
        std::future::poll_fn(|context| {
            if let std::task::Poll::Ready(outcome) = serving.as_mut().poll(context) {
                return std::task::Poll::Ready(outcome);
            }
            ended.as_mut().poll(context).map(Ok)
        })
        .await
        .map_err(failed)
    });
    runtime.shutdown_timeout(GRACE);
    outcome
}
