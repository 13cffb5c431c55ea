//! The DevTools protocol over a pipe: JSON objects, each ended by a zero byte; what carries a `sessionId` belongs to a page,
//! the rest to the browser.

use serde_json::{Value, json};
use std::cell::RefCell;
use std::collections::HashMap;
use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdin, ChildStdout};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Instant;

/// Where the messages of each session go.
type Inboxes = Arc<Mutex<HashMap<String, Sender<Value>>>>;

/// Both ends of the connection.
pub struct Pipe {
    sink: Mutex<ChildStdin>,
    inboxes: Inboxes,
    calls: AtomicU64,
}

impl Pipe {
    /// Reads on a thread of its own, which ends with the browser.
    pub fn new(sink: ChildStdin, source: ChildStdout) -> Arc<Self> {
        let inboxes = Inboxes::default();
        let readers = Arc::clone(&inboxes);
        thread::spawn(move || {
            for message in BufReader::new(source).split(0).map_while(Result::ok) {
                let message: Value = serde_json::from_slice(&message).unwrap_or_default();
                let session = message["sessionId"].as_str().unwrap_or("");
                if let Some(inbox) = readers.lock().unwrap().get(session) {
                    let _ = inbox.send(message); // a page that is gone needs none
                }
            }
            // whoever still waits learns that nothing will come
            readers.lock().unwrap().clear();
        });
        Arc::new(Pipe { sink: Mutex::new(sink), inboxes, calls: AtomicU64::new(1) })
    }
}

/// A conversation with the browser or with one page.
pub struct Session {
    pipe: Arc<Pipe>,
    id: String,
    inbox: Receiver<Value>,
    events: RefCell<Vec<Value>>,
}

impl Session {
    /// Listens to a session; that of the browser has no name.
    pub fn new(pipe: &Arc<Pipe>, id: &str) -> Self {
        let (sender, inbox) = channel();
        pipe.inboxes.lock().unwrap().insert(id.to_owned(), sender);
        Session { pipe: Arc::clone(pipe), id: id.to_owned(), inbox, events: RefCell::default() }
    }

    /// Sends a command and waits for its answer until `deadline`.
    pub fn call(&self, method: &str, params: Value, deadline: Instant) -> Result<Value, String> {
        let id = self.pipe.calls.fetch_add(1, Ordering::Relaxed);
        let mut message = json!({ "id": id, "method": method, "params": params });
        if !self.id.is_empty() {
            message["sessionId"] = json!(self.id);
        }
        let mut bytes = serde_json::to_vec(&message).unwrap();
        bytes.push(0);
        let sent = self.pipe.sink.lock().unwrap().write_all(&bytes);
        sent.map_err(|e| format!("{method}: the browser hears nothing: {e}"))?;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let mut answer = self.inbox.recv_timeout(left).map_err(|e| match e {
                RecvTimeoutError::Timeout => format!("{method}: no answer in time"),
                RecvTimeoutError::Disconnected => format!("{method}: the browser has ended"),
            })?;
            if answer["id"] != id {
                self.events.borrow_mut().push(answer);
            } else if answer["error"].is_null() {
                return Ok(answer["result"].take());
            } else {
                return Err(format!("{method}: {}", answer["error"]));
            }
        }
    }

    /// The parameters of all events of this name so far.
    pub fn events(&self, method: &str) -> Vec<Value> {
        let mut events = self.events.borrow_mut();
        events.extend(self.inbox.try_iter());
        events.iter().filter(|event| event["method"] == method).map(|event| event["params"].clone()).collect()
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.pipe.inboxes.lock().unwrap().remove(&self.id);
    }
}
