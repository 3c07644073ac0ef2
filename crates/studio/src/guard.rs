//! Who may ask: the page itself. Other pages in the same browser reach 127.0.0.1, too, some of them under a name of
//! their own that leads there (DNS rebinding), and other users of the machine reach the port. Against the first two
//! stand `Host` and `Origin`, against all of them the token.

use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, HeaderName, HeaderValue, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS,
};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::fmt::Write as _;
use std::sync::Arc;

use crate::problem::Problem;

/// Where the token of a request stands. A header that is no standard one: other origins could not send it unasked.
pub const TOKEN_HEADER: HeaderName = HeaderName::from_static("x-gearmesh-token");

/// Everything comes from this server; styles that scripts set are those of the charts.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; \
     connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Bytes of a token: more than can be tried.
const TOKEN_BYTES: usize = 24;

/// Where the server listens, and what it asks for.
#[derive(Debug)]
pub struct Address {
    port: u16,
    token: String,
}

impl Address {
    /// An address with a new token.
    ///
    /// # Errors
    /// [`Problem::Work`] where the system has no random numbers.
    pub fn new(port: u16) -> Result<Self, Problem> {
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes)
            .map_err(|error| Problem::Work(format!("no random numbers for the token: {error}")))?;
        let mut token = String::with_capacity(2 * TOKEN_BYTES);
        for byte in bytes {
            let _ = write!(token, "{byte:02x}");
        }
        Ok(Self { port, token })
    }

    /// What the browser opens.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    fn is_own_host(&self, host: &str) -> bool {
        let Self { port, .. } = self;
        host == format!("127.0.0.1:{port}") || host == format!("localhost:{port}")
    }

    fn is_own_origin(&self, origin: &str) -> bool {
        (origin.strip_prefix("http://")).is_some_and(|host| self.is_own_host(host))
    }

    /// Compared to the end, however early it differs.
    fn is_token(&self, found: &[u8]) -> bool {
        let own = self.token.as_bytes();
        let differ = own.iter().zip(found).fold(0, |all, (a, b)| all | (a ^ b));
        own.len() == found.len() && differ == 0
    }
}

/// A header that stands there once, as text.
fn only<'a>(request: &'a Request, name: &HeaderName) -> Option<&'a str> {
    let mut all = request.headers().get_all(name).iter();
    match (all.next(), all.next()) {
        (Some(one), None) => one.to_str().ok(),
        _ => None,
    }
}

/// Refuses what is meant for another name or comes from another page, and forbids the browser everything that this page
/// does not need.
pub async fn own_page(
    State(address): State<Arc<Address>>,
    request: Request,
    next: Next,
) -> Response {
    let is_own_host = only(&request, &HOST).is_some_and(|host| address.is_own_host(host));
    let is_own_origin = !request.headers().contains_key(ORIGIN)
        || only(&request, &ORIGIN).is_some_and(|origin| address.is_own_origin(origin));
    let mut response = match (is_own_host, is_own_origin) {
        (true, true) => next.run(request).await,
        (false, _) => Problem::Forbidden("the request names another host").into_response(),
        (_, false) => Problem::Forbidden("the request comes from another page").into_response(),
    };
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        // The address has the token.
        (REFERRER_POLICY, "no-referrer"),
        (CACHE_CONTROL, "no-store"),
    ] {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}

/// Refuses what does not know the token.
pub async fn with_token(
    State(address): State<Arc<Address>>,
    request: Request,
    next: Next,
) -> Response {
    let known =
        only(&request, &TOKEN_HEADER).is_some_and(|token| address.is_token(token.as_bytes()));
    if known {
        return next.run(request).await;
    }
    Problem::Forbidden("the token is missing or wrong; open the address that the program printed")
        .into_response()
}
