//! What stands at which address, and who answers.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, PoisonError, RwLock};

use axum::body::Bytes;
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
use crate::beginning::{self, Edit, NewFiles};
use crate::bevel::BevelModels;
use crate::choice::Chosen;
use crate::columns::{ColumnsSession, CurvesAsked, StretchAsked};
use crate::guard::{self, Address};
use crate::job::Job;
use crate::latest::Latest;
use crate::modes::ModeAsked;
use crate::opened::Opened;
use crate::pair::Change;
use crate::problem::Problem;
use crate::seek::Seek;
use crate::waterfall::WaterfallAsked;

/// Bytes of a request: pitch errors of two gears with some hundred teeth need some kilobytes.
const MOST_BYTES: usize = 256 << 10;

/// Bytes of a gearbox file.
const MOST_GEARBOX_BYTES: usize = 64 << 20;

/// What the requests share.
#[derive(Debug)]
pub struct Studio {
    /// What is shown; another one once something new has been made.
    opened: RwLock<Arc<Opened>>,
    /// The calculations.
    pub latest: Latest,
    /// What takes longer.
    pub job: Job,
    /// Models of the bevel pair that is begun.
    bevel_models: BevelModels,
    /// Once true, the server ends.
    pub stop: Arc<AtomicBool>,
}

type Shared = State<Arc<Studio>>;

/// What most requests are answered with.
type Answered = Result<Json<Value>, Problem>;

impl Studio {
    /// Shows what was opened.
    pub fn new(opened: Opened, stop: Arc<AtomicBool>) -> Self {
        Self {
            opened: RwLock::new(Arc::new(opened)),
            latest: Latest::default(),
            job: Job::default(),
            bevel_models: BevelModels::default(),
            stop,
        }
    }

    fn opened(&self) -> Arc<Opened> {
        Arc::clone(&self.opened.read().unwrap_or_else(PoisonError::into_inner))
    }

    /// Begins what takes longer, and says how far it is.
    fn begin(
        &self,
        name: &str,
        work: impl FnOnce(&Watch<'_>) -> Result<Value, Problem> + Send + 'static,
    ) -> Json<Value> {
        self.job.begin(name.to_owned(), work);
        Json(self.job.progress())
    }

    /// What is found of the columns that are shown, off the loop that answers.
    async fn of_columns(
        &self,
        find: impl FnOnce(&ColumnsSession) -> Result<Value, Problem> + Send + 'static,
    ) -> Answered {
        let opened = self.opened();
        opened.columns()?;
        let found = self.latest.run(move |_| find(opened.columns()?));
        Ok(Json(found.await?))
    }

    fn open(&self, other: Opened) {
        *self.opened.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(other);
    }
}

pub fn router(studio: Arc<Studio>, address: Arc<Address>) -> Router {
    let api = Router::new()
        .route("/session", get(session))
        .route("/pair", get(pair).post(change))
        .route("/pair/toml", post(toml))
        .route("/pair/gears", post(gears))
        .route("/pair/reduce", post(reduce))
        .route("/columns", get(columns).post(curves))
        .route("/columns/moments", post(moments))
        .route("/columns/waterfall", post(waterfall))
        .route("/columns/planets", post(planets))
        .route("/scene", get(scene).post(run))
        .route("/folder", get(folder).post(choose))
        .route("/modes", get(modes).post(mode))
        .route("/progress", get(progress))
        .route("/pair/optimise", post(seek))
        .route("/new", get(new).post(look))
        .route("/new/edit", post(edit))
        .route("/new/begin", post(begin))
        .route("/new/start", post(start))
        .route(
            "/new/import/{name}",
            post(import).layer(DefaultBodyLimit::max(MOST_GEARBOX_BYTES)),
        )
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
    Json(json!({"kind": studio.opened().kind(), "version": env!("CARGO_PKG_VERSION")}))
}

async fn pair(State(studio): Shared) -> Answered {
    Ok(Json(
        studio.opened().pair()?.description(&Change::default())?,
    ))
}

/// The calculation and its text, both off the loop that answers.
async fn change(State(studio): Shared, Body(change): Body<Change>) -> Result<Response, Problem> {
    studio.opened().pair()?;
    let worker = Arc::clone(&studio);
    let text = studio.latest.run(move |watch| {
        let answer = worker.opened().pair()?.answer(&change, watch)?;
        serde_json::to_string(&answer).map_err(|error| Problem::Work(error.to_string()))
    });
    let text = text.await?;
    Ok(([(CONTENT_TYPE, "application/json")], text).into_response())
}

async fn toml(State(studio): Shared, Body(change): Body<Change>) -> Result<String, Problem> {
    studio.opened().pair()?.toml(&change)
}

/// The keys and the shapes of changed gears; they may not be reduced yet.
async fn gears(State(studio): Shared, Body(change): Body<Change>) -> Answered {
    Ok(Json(studio.opened().pair()?.description(&change)?))
}

async fn reduce(State(studio): Shared, Body(change): Body<Change>) -> Answered {
    studio.opened().pair()?;
    let worker = Arc::clone(&studio);
    let name = format!("reduce {}", change.of_bodies());
    let work = move |watch: &Watch<'_>| worker.opened().pair()?.reduce(&change, watch);
    Ok(studio.begin(&name, work))
}

async fn job(State(studio): Shared) -> Json<Value> {
    Json(studio.job.progress())
}

async fn stop_job(State(studio): Shared) -> Json<Value> {
    studio.job.stop();
    Json(json!({}))
}

async fn columns(State(studio): Shared) -> Answered {
    Ok(Json(studio.opened().columns()?.description()))
}

async fn curves(State(studio): Shared, Body(asked): Body<CurvesAsked>) -> Answered {
    studio.opened().columns()?;
    let worker = Arc::clone(&studio);
    let curves = (studio.latest).run(move |_| worker.opened().columns()?.curves(&asked));
    Ok(Json(curves.await?))
}

async fn scene(State(studio): Shared) -> Answered {
    Ok(Json(studio.opened().scene()?.description()))
}

/// Runs the scene, and opens its result.
async fn run(State(studio): Shared) -> Answered {
    let opened = studio.opened();
    opened.scene()?;
    let worker = Arc::clone(&studio);
    let work = move |watch: &Watch<'_>| {
        let result = opened.scene()?.run(watch)?;
        worker.open(Opened::named(&result)?);
        Ok(json!({}))
    };
    Ok(studio.begin("run", work))
}

async fn folder(State(studio): Shared) -> Answered {
    Ok(Json(studio.opened().folder()?.description()))
}

/// Opens a file of the folder.
async fn choose(State(studio): Shared, Body(chosen): Body<Chosen>) -> Answered {
    let path = studio.opened().folder()?.chosen(&chosen)?.to_owned();
    // Models and results may be long: off the loop that answers.
    let opened = tokio::task::spawn_blocking(move || Opened::named(&path)).await;
    let failed = |error| Problem::Work(format!("the file could not be opened: {error}"));
    studio.open(opened.map_err(failed)??);
    Ok(Json(json!({})))
}

async fn modes(State(studio): Shared) -> Answered {
    Ok(Json(studio.opened().modes()?.description()))
}

async fn mode(State(studio): Shared, Body(asked): Body<ModeAsked>) -> Answered {
    Ok(Json(studio.opened().modes()?.frames(&asked)?))
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

async fn waterfall(State(studio): Shared, Body(asked): Body<WaterfallAsked>) -> Answered {
    let find = move |columns: &ColumnsSession| columns.waterfall(&asked);
    studio.of_columns(find).await
}

async fn planets(State(studio): Shared, Body(asked): Body<StretchAsked>) -> Answered {
    let find = move |columns: &ColumnsSession| columns.planets(&asked);
    studio.of_columns(find).await
}

async fn moments(State(studio): Shared, Body(asked): Body<StretchAsked>) -> Answered {
    let opened = studio.opened();
    opened.columns()?;
    let name = format!("moments {asked:?}");
    let work = move |watch: &Watch<'_>| opened.columns()?.moments(&asked, watch);
    Ok(studio.begin(&name, work))
}

async fn seek(State(studio): Shared, Body(seek): Body<Seek>) -> Answered {
    let opened = studio.opened();
    opened.pair()?;
    let work = move |watch: &Watch<'_>| opened.pair()?.seek(&seek, watch);
    Ok(studio.begin("optimise", work))
}

async fn new(State(studio): Shared) -> Json<Value> {
    Json(beginning::kinds(studio.opened().begun()))
}

async fn edit(Body(edit): Body<Edit>) -> Answered {
    Ok(Json(beginning::edited(&edit)?))
}

/// Bearings are computed while one types: off the loop that answers.
async fn look(State(studio): Shared, Body(files): Body<NewFiles>) -> Answered {
    let worker = Arc::clone(&studio);
    let found = (studio.latest)
        .run(move |watch| beginning::looked_at(&files, &worker.bevel_models, &watch.stop));
    Ok(Json(found.await?))
}

async fn begin(State(studio): Shared, Body(files): Body<NewFiles>) -> Json<Value> {
    let worker = Arc::clone(&studio);
    let work = move |watch: &Watch<'_>| {
        let (result, file) = beginning::begun(&files, watch)?;
        if result["opens"] == json!(true) {
            worker.open(Opened::named(&file)?);
        }
        Ok(result)
    };
    studio.begin("begin", work)
}

/// Leaves what is shown for something new.
async fn start(State(studio): Shared) -> Json<Value> {
    studio.open(Opened::New(None));
    Json(json!({}))
}

async fn import(State(studio): Shared, Path(name): Path<String>, bytes: Bytes) -> Json<Value> {
    let work = move |watch: &Watch<'_>| beginning::imported(&name, &bytes, watch);
    studio.begin("import", work)
}
