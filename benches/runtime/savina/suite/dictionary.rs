//! A dictionary that many actors read and write: requests with answers, to one actor.
//!
//! Original: 20 workers, 10,000 requests each, one in ten writes. Counted: requests and answers. Checked: each worker
//! writes only keys of its own, so it reads from them what it wrote last; of other workers' keys it never reads an
//! older version than before; at the end the dictionary contains what the workers wrote.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;
use dragonfly_kit::random::Random;
use std::collections::HashMap;

/// Number of keys that each worker owns.
const KEYS: usize = 64;
/// One in this number of requests is a write.
const WRITES: usize = 10;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (workers, requests) = mode.pick((4, 50), (20, 1_000), (20, 10_000));
    let owned = |key: usize| (key, KeyVersion { key, version: 0 });
    let entries: HashMap<usize, KeyVersion> = (0..KEYS * workers).map(owned).collect();
    let dictionary = Dictionary { entries, workers: Vec::new(), requests, ended: 0, served: 0 };
    let dictionary = world.spawn(0, dictionary);
    let create = |index: usize| {
        let (random, seen) = (Random::new(index as u64), vec![0; KEYS * workers]);
        let worker = DictionaryWorker {
            index,
            workers,
            dictionary: dictionary.clone(),
            random,
            seen,
            key: 0,
            left: requests,
        };
        world.spawn(index, worker)
    };
    let workers: Vec<Address<DictionaryWorker>> = (0..workers).map(create).collect();
    world.send(&dictionary, DictionaryMessage::Open(workers));
}

/// The value of a key: the number of times that it was written. It contains the key, so that a wrong answer is
/// detected.
#[derive(Clone, Copy, Debug, PartialEq)]
struct KeyVersion {
    key: usize,
    version: u32,
}

struct Dictionary {
    entries: HashMap<usize, KeyVersion>,
    workers: Vec<Address<DictionaryWorker>>,
    requests: u64,
    ended: usize,
    served: u64,
}

enum DictionaryMessage {
    Open(Vec<Address<DictionaryWorker>>),
    Read { from: usize, key: usize },
    Write { from: usize, value: KeyVersion },
    End { owned: Vec<KeyVersion> },
}

impl Actor for Dictionary {
    type Message = DictionaryMessage;

    fn receive(&mut self, message: DictionaryMessage, cx: &mut Cx<Self>) {
        match message {
            DictionaryMessage::Open(workers) => {
                workers.iter().for_each(|worker| cx.send(worker, DictionaryReply::Begin));
                self.workers = workers;
            }
            DictionaryMessage::Read { from, key } => {
                self.served += 1;
                cx.send(&self.workers[from], DictionaryReply::Value(self.entries[&key]));
            }
            DictionaryMessage::Write { from, value } => {
                self.served += 1;
                self.entries.insert(value.key, value);
                cx.send(&self.workers[from], DictionaryReply::Value(value));
            }
            DictionaryMessage::End { owned } => {
                for value in owned {
                    assert_eq!(self.entries[&value.key], value, "the dictionary is what its writer knows");
                }
                self.ended += 1;
                if self.ended == self.workers.len() {
                    assert_eq!(self.served, self.requests * self.ended as u64, "every request was served");
                    cx.finish(2 * self.served, None);
                    cx.stop();
                }
            }
        }
    }
}

struct DictionaryWorker {
    index: usize,
    workers: usize,
    dictionary: Address<Dictionary>,
    random: Random,
    /// Last version of each key that was read or written.
    seen: Vec<u32>,
    /// Key of the current request.
    key: usize,
    left: u64,
}

enum DictionaryReply {
    Begin,
    Value(KeyVersion),
}

impl Actor for DictionaryWorker {
    type Message = DictionaryReply;

    fn receive(&mut self, message: DictionaryReply, cx: &mut Cx<Self>) {
        if let DictionaryReply::Value(KeyVersion { key, version }) = message {
            assert_eq!(key, self.key, "the answer is to the question");
            if self.owns(key) {
                assert_eq!(version, self.seen[key], "its own key has changed");
            }
            assert!(version >= self.seen[key], "key {key} has become older");
            self.seen[key] = version;
        }
        self.request(cx);
    }
}

impl DictionaryWorker {
    fn owns(&self, key: usize) -> bool {
        key % self.workers == self.index
    }

    /// Makes the next request, or reports the versions of its keys at the end.
    fn request(&mut self, cx: &mut Cx<Self>) {
        if self.left == 0 {
            let keys = (0..self.seen.len()).filter(|key| self.owns(*key));
            let owned = keys.map(|key| KeyVersion { key, version: self.seen[key] }).collect();
            cx.send(&self.dictionary, DictionaryMessage::End { owned });
            return cx.stop();
        }
        self.left -= 1;
        let from = self.index;
        if self.random.below(WRITES) == 0 {
            self.key = self.random.below(KEYS) * self.workers + self.index;
            self.seen[self.key] += 1;
            let value = KeyVersion { key: self.key, version: self.seen[self.key] };
            cx.send(&self.dictionary, DictionaryMessage::Write { from, value });
        } else {
            self.key = self.random.below(self.seen.len());
            cx.send(&self.dictionary, DictionaryMessage::Read { from, key: self.key });
        }
    }
}
