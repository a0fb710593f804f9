//! Topics: messages from publishers to all subscribers of a name, as ROS has them.

use std::collections::{BTreeMap, VecDeque};

use crate::stored::check_name;
use crate::{ApiError, Value};

/// Publishers and subscribers that may exist at once.
const MAX_ENDS: usize = 1_000;
/// Messages that a subscriber keeps at most; the oldest are dropped.
const MAX_MESSAGES: usize = 1_000;

/// Publishers and subscribers of all topics, by handles that no two of them share.
#[derive(Clone, Debug, Default)]
pub struct Topics {
    ends: BTreeMap<i64, End>,
    n_made: i64,
}

#[derive(Clone, Debug)]
struct End {
    /// Number of the script that has opened it.
    owner: usize,
    topic: String,
    role: Role,
}

#[derive(Clone, Debug)]
enum Role {
    /// With the last message, if later subscribers are to get it.
    Publisher {
        latches: bool,
        last: Option<Value>,
    },
    Subscriber {
        capacity: usize,
        received: VecDeque<Value>,
    },
}

impl Topics {
    /// Creates a publisher and returns its handle. One that latches hands its last message to later subscribers.
    ///
    /// # Errors
    ///
    /// The topic has no name, or there are too many publishers and subscribers.
    pub fn advertise(&mut self, owner: usize, topic: &str, latches: bool) -> Result<i64, ApiError> {
        self.open(owner, topic, Role::Publisher { latches, last: None })
    }

    /// Creates a subscriber that keeps `capacity` messages, 1,000 at most, and returns its handle.
    ///
    /// # Errors
    ///
    /// As [`Topics::advertise`].
    pub fn subscribe(&mut self, owner: usize, topic: &str, capacity: usize) -> Result<i64, ApiError> {
        let capacity = capacity.clamp(1, MAX_MESSAGES);
        let mut received = VecDeque::new();
        for end in self.ends.values().filter(|end| end.topic == bare(topic)) {
            if let Role::Publisher { last: Some(message), .. } = &end.role {
                received.push_back(message.clone());
            }
        }
        self.open(owner, topic, Role::Subscriber { capacity, received })
    }

    fn open(&mut self, owner: usize, topic: &str, role: Role) -> Result<i64, ApiError> {
        let topic = bare(topic);
        check_name("topic", topic)?;
        if topic.is_empty() {
            return Err(ApiError::new("a topic has a name"));
        }
        if self.ends.len() >= MAX_ENDS {
            return Err(ApiError(format!("there are {MAX_ENDS} publishers and subscribers already: shut some down")));
        }
        self.n_made += 1;
        self.ends.insert(self.n_made, End { owner, topic: topic.to_owned(), role });
        Ok(self.n_made)
    }

    /// Hands a message to all subscribers of the topic of a publisher.
    ///
    /// # Errors
    ///
    /// There is no such publisher.
    pub fn publish(&mut self, handle: i64, message: &Value) -> Result<(), ApiError> {
        let missing = || ApiError(format!("there is no publisher {handle}"));
        let End { topic, role: Role::Publisher { latches, last }, .. } =
            self.ends.get_mut(&handle).ok_or_else(missing)?
        else {
            return Err(missing());
        };
        if *latches {
            *last = Some(message.clone());
        }
        let topic = topic.clone();
        for end in self.ends.values_mut().filter(|end| end.topic == topic) {
            if let Role::Subscriber { capacity, received } = &mut end.role {
                if received.len() >= *capacity {
                    received.pop_front();
                }
                received.push_back(message.clone());
            }
        }
        Ok(())
    }

    /// Returns true if a subscriber of a script has messages.
    #[must_use]
    pub fn has_messages(&self, owner: usize) -> bool {
        let waits = |end: &End| matches!(&end.role, Role::Subscriber { received, .. } if !received.is_empty());
        self.ends.values().any(|end| end.owner == owner && waits(end))
    }

    /// Takes the messages of all subscribers of a script, each with the handle of its subscriber, in the order of
    /// handles and of arrival.
    pub fn take(&mut self, owner: usize) -> Vec<(i64, Value)> {
        let mut taken = Vec::new();
        for (handle, end) in self.ends.iter_mut().filter(|(_, end)| end.owner == owner) {
            if let Role::Subscriber { received, .. } = &mut end.role {
                taken.extend(received.drain(..).map(|message| (*handle, message)));
            }
        }
        taken
    }

    /// Removes a publisher or subscriber.
    ///
    /// # Errors
    ///
    /// There is none of that handle.
    pub fn shut_down(&mut self, handle: i64) -> Result<(), ApiError> {
        let removed = self.ends.remove(&handle);
        removed.map(drop).ok_or_else(|| ApiError(format!("there is no publisher or subscriber {handle}")))
    }

    /// Removes all publishers and subscribers of a script that has ended.
    pub fn forget(&mut self, owner: usize) {
        self.ends.retain(|_, end| end.owner != owner);
    }
}

/// Name of a topic without the slash of the global namespace, which is the only one.
fn bare(topic: &str) -> &str {
    topic.strip_prefix('/').unwrap_or(topic)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_reaches_all_subscribers_of_its_topic_and_no_others() {
        let mut topics = Topics::default();
        let publisher = topics.advertise(0, "/speed", false).unwrap();
        let one = topics.subscribe(1, "speed", 10).unwrap();
        let other = topics.subscribe(1, "/speed", 10).unwrap();
        topics.subscribe(2, "/place", 10).unwrap();
        topics.publish(publisher, &Value::Int(3)).unwrap();
        assert!(topics.has_messages(1) && !topics.has_messages(2) && !topics.has_messages(0));
        assert_eq!(topics.take(1), [(one, Value::Int(3)), (other, Value::Int(3))]);
        assert!(topics.take(1).is_empty());
    }

    #[test]
    fn a_full_subscriber_drops_the_oldest_message() {
        let mut topics = Topics::default();
        let publisher = topics.advertise(0, "x", false).unwrap();
        let subscriber = topics.subscribe(1, "x", 2).unwrap();
        (0..5).for_each(|k| topics.publish(publisher, &Value::Int(k)).unwrap());
        assert_eq!(topics.take(1), [(subscriber, Value::Int(3)), (subscriber, Value::Int(4))]);
    }

    #[test]
    fn a_latched_message_reaches_later_subscribers() {
        let mut topics = Topics::default();
        let [kept, lost] = [true, false].map(|latches| topics.advertise(0, "map", latches).unwrap());
        topics.publish(kept, &Value::Int(1)).unwrap();
        topics.publish(lost, &Value::Int(2)).unwrap();
        let late = topics.subscribe(1, "map", 10).unwrap();
        assert_eq!(topics.take(1), [(late, Value::Int(1))]);
    }

    #[test]
    fn what_was_shut_down_or_has_ended_is_gone() {
        let mut topics = Topics::default();
        let publisher = topics.advertise(0, "x", false).unwrap();
        let subscriber = topics.subscribe(1, "x", 1).unwrap();
        topics.shut_down(subscriber).unwrap();
        assert!(topics.shut_down(subscriber).is_err() && topics.publish(subscriber, &Value::Nil).is_err());
        topics.publish(publisher, &Value::Nil).unwrap();
        topics.forget(0);
        assert!(topics.publish(publisher, &Value::Nil).is_err());
        assert!(topics.advertise(0, "", false).is_err());
    }
}
