//! The server: what stands at which address.

use std::net::Ipv4Addr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::extract::rejection::JsonRejection;
use axum::extract::{DefaultBodyLimit, FromRequest, Path, State};
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::middleware::{from_fn_with_state, map_response};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use gearmesh_operations::Watch;
use serde_json::{Value, json};

use crate::assets;
use crate::columns::CurvesAsked;
use crate::guard::{self, Address};
use crate::job::Job;
use crate::latest::Latest;
use crate::opened::Opened;
use crate::pair::Change;
use crate::problem::Problem;

/// Bytes of a request: pitch errors of two gears with some hundred teeth need some kilobytes.
const MOST_BYTES: usize = 256 << 10;

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

#[derive(Debug)]
struct Studio {
    opened: Opened,
    latest: Latest,
    job: Job,
    stop: Arc<AtomicBool>,
}

type Shared = State<Arc<Studio>>;

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
        let studio = Arc::new(Studio {
            opened,
            latest: Latest::default(),
            job: Job::default(),
            stop: Arc::clone(&options.stop),
        });
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

fn router(studio: Arc<Studio>, address: Arc<Address>) -> Router {
    let api = Router::new()
        .route("/session", get(session))
        .route("/pair", get(pair).post(change))
        .route("/pair/toml", post(toml))
        .route("/pair/gears", post(gears))
        .route("/pair/reduce", post(reduce))
        .route("/columns", get(columns).post(curves))
        .route("/progress", get(progress))
        .route("/stop", post(stop))
        .route("/job", get(job))
        .route("/job/stop", post(stop_job))
        .route("/quit", post(quit))
        .fallback(absent)
        .layer(DefaultBodyLimit::max(MOST_BYTES))
        .layer(from_fn_with_state(Arc::clone(&address), guard::with_token))
        .with_state(studio);
    Router::new()
        .nest("/api", api)
        .route("/", get(|| async { served("index.html") }))
        .route(
            "/assets/{name}",
            get(|Path(name): Path<String>| async move { served(&name) }),
        )
        .fallback(absent)
        .layer(map_response(own_words))
        .layer(from_fn_with_state(address, guard::own_page))
}

fn served(name: &str) -> Result<Response, Problem> {
    let found = assets::asset(name).ok_or(Problem::Absent)?;
    Ok(([(CONTENT_TYPE, found.kind)], found.text).into_response())
}

async fn absent() -> Problem {
    Problem::Absent
}

/// Answers of the framework that have no body get one.
async fn own_words(response: Response) -> Response {
    match response.status() {
        StatusCode::METHOD_NOT_ALLOWED => Problem::Absent.into_response(),
        _ => response,
    }
}

/// A body in JSON; what is wrong with it is said as everywhere else.
struct Body<T>(T);

impl<S: Send + Sync, T: serde::de::DeserializeOwned> FromRequest<S> for Body<T> {
    type Rejection = Response;

    async fn from_request(
        request: axum::extract::Request,
        state: &S,
    ) -> Result<Self, Self::Rejection> {
        match Json::<T>::from_request(request, state).await {
            Ok(Json(body)) => Ok(Self(body)),
            Err(rejection) => Err(refused(&rejection)),
        }
    }
}

fn refused(rejection: &JsonRejection) -> Response {
    let body = json!({"kind": "input", "error": rejection.body_text()});
    (rejection.status(), Json(body)).into_response()
}

async fn session(State(studio): Shared) -> Json<Value> {
    Json(json!({"kind": studio.opened.kind(), "version": env!("CARGO_PKG_VERSION")}))
}

async fn pair(State(studio): Shared) -> Result<Json<Value>, Problem> {
    Ok(Json(studio.opened.pair()?.description(&Change::default())?))
}

/// The calculation and its text, both off the loop that answers.
async fn change(State(studio): Shared, Body(change): Body<Change>) -> Result<Response, Problem> {
    studio.opened.pair()?;
    let worker = Arc::clone(&studio);
    let text = studio.latest.run(move |watch| {
        let answer = worker.opened.pair()?.answer(&change, watch)?;
        serde_json::to_string(&answer).map_err(|error| Problem::Work(error.to_string()))
    });
    let text = text.await?;
    Ok(([(CONTENT_TYPE, "application/json")], text).into_response())
}

async fn toml(State(studio): Shared, Body(change): Body<Change>) -> Result<String, Problem> {
    studio.opened.pair()?.toml(&change)
}

/// The keys and the shapes of changed gears; they may not be reduced yet.
async fn gears(State(studio): Shared, Body(change): Body<Change>) -> Result<Json<Value>, Problem> {
    Ok(Json(studio.opened.pair()?.description(&change)?))
}

async fn reduce(State(studio): Shared, Body(change): Body<Change>) -> Result<Json<Value>, Problem> {
    studio.opened.pair()?;
    let worker = Arc::clone(&studio);
    let name = format!("reduce {}", change.of_bodies());
    let work = move |watch: &Watch<'_>| worker.opened.pair()?.reduce(&change, watch);
    studio.job.begin(name, work);
    Ok(Json(studio.job.progress()))
}

async fn job(State(studio): Shared) -> Json<Value> {
    Json(studio.job.progress())
}

async fn stop_job(State(studio): Shared) -> Json<Value> {
    studio.job.stop();
    Json(json!({}))
}

async fn columns(State(studio): Shared) -> Result<Json<Value>, Problem> {
    Ok(Json(studio.opened.columns()?.description()))
}

async fn curves(
    State(studio): Shared,
    Body(asked): Body<CurvesAsked>,
) -> Result<Json<Value>, Problem> {
    studio.opened.columns()?;
    let worker = Arc::clone(&studio);
    let curves = (studio.latest).run(move |_| worker.opened.columns()?.curves(&asked));
    Ok(Json(curves.await?))
}

async fn progress(State(studio): Shared) -> Json<Value> {
    Json(json!({"solved": studio.latest.solved()}))
}

async fn stop(State(studio): Shared) -> Json<Value> {
    studio.latest.stop();
    Json(json!({}))
}

async fn quit(State(studio): Shared) -> Json<Value> {
    studio.stop.store(true, Ordering::Relaxed);
    Json(json!({}))
}
