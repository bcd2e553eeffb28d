//! Commands on their way to the leg. One is unanswered at a time; a newer one replaces one of its kind that waits. So the
//! board's queue never fills, however slowly the simulated time runs.

use leg_base::refusal;
use leg_firmware::command::Command;
use leg_firmware::host_link::HostRefusal;
use std::collections::VecDeque;
use std::mem::discriminant;

/// A command, and what the window calls it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// What the leg is to do.
    pub command: Command,
    /// Its name in messages.
    pub name: &'static str,
}

impl Order {
    fn stops(&self) -> bool {
        self.command == Command::Stop
    }

    fn same_kind(&self, other: &Self) -> bool {
        discriminant(&self.command) == discriminant(&other.command)
    }
}

/// The commands that are not answered yet.
#[derive(Debug, Default)]
pub struct Orders {
    /// Those that were sent, with their numbers: at most one, and a stop after it.
    sent: Vec<(u16, Order)>,
    /// Those that are sent later, the next one first: at most one of each kind.
    waiting: VecDeque<Order>,
}

impl Orders {
    /// Takes a command. A stop cancels what waits.
    pub fn take(&mut self, order: Order) {
        if order.stops() {
            self.waiting.clear();
            // Nothing is sent after an unanswered stop: another one would change nothing.
            if self.stopping() {
                return;
            }
        }
        self.waiting.retain(|other| !other.same_kind(&order));
        self.waiting.push_back(order);
    }

    /// The command to be sent now; none while another one is unanswered. A stop does not wait for an answer.
    pub fn next_to_send(&mut self) -> Option<Order> {
        let stop = self.waiting.front().is_some_and(Order::stops);
        if stop || self.sent.is_empty() {
            self.waiting.pop_front()
        } else {
            None
        }
    }

    /// Notes that a command was sent under a number.
    pub fn note_sent(&mut self, number: u16, order: Order) {
        self.sent.push((number, order));
    }

    /// The command that an answer is to; none for an answer to something else.
    pub fn answered(&mut self, number: u16) -> Option<Order> {
        let place = self.sent.iter().position(|(sent, _)| *sent == number)?;
        Some(self.sent.remove(place).1)
    }

    /// Sends a command again, unless a stop or a newer one of its kind came after it.
    pub fn repeat(&mut self, order: Order) {
        let replaced = |other: &Order| other.stops() || other.same_kind(&order);
        if !self.stopping() && !self.waiting.iter().any(replaced) {
            self.waiting.push_front(order);
        }
    }

    /// The commands that wait, the next one first.
    pub fn waiting(&self) -> impl Iterator<Item = &Order> {
        self.waiting.iter()
    }

    /// Whether nothing waits, or is unanswered.
    #[must_use]
    pub fn answered_all(&self) -> bool {
        self.sent.is_empty() && self.waiting.is_empty()
    }

    /// Whether one was sent that is not answered.
    #[must_use]
    pub fn unanswered(&self) -> bool {
        !self.sent.is_empty()
    }

    fn stopping(&self) -> bool {
        self.sent.iter().any(|(_, order)| order.stops())
    }
}

/// The remedies of a command that the leg refuses hold for any host; the others are those of the program `leg`.
#[must_use]
pub fn refused(name: &str, refusal: &HostRefusal) -> String {
    match refusal {
        HostRefusal::Command(refusal) => {
            let [wrong, remedy] = refusal.description();
            format!("{name} refused: {wrong}; {remedy}")
        }
        other => {
            let [wrong, _] = refusal::description(other);
            format!("{name} refused: {wrong}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Order, Orders};
    use leg_firmware::command::Command;

    fn order(command: Command) -> Order {
        Order {
            command,
            name: "test",
        }
    }

    fn move_to(x: f32) -> Order {
        order(Command::Move { x, y: 0.0 })
    }

    fn send(orders: &mut Orders, number: u16) -> Option<Order> {
        let next = orders.next_to_send()?;
        orders.note_sent(number, next);
        Some(next)
    }

    #[test]
    fn the_newest_of_a_kind_waits_for_the_answer() {
        let mut orders = Orders::default();
        orders.take(move_to(0.1));
        assert_eq!(send(&mut orders, 1), Some(move_to(0.1)));
        for x in [0.2, 0.3] {
            orders.take(move_to(x));
            assert_eq!(send(&mut orders, 2), None);
        }
        orders.take(order(Command::Hold));
        assert_eq!(orders.waiting().count(), 2);
        assert_eq!(orders.answered(9), None);
        assert_eq!(orders.answered(1), Some(move_to(0.1)));
        assert_eq!(send(&mut orders, 2), Some(move_to(0.3)));
        orders.answered(2);
        assert_eq!(send(&mut orders, 3), Some(order(Command::Hold)));
    }

    #[test]
    fn a_stop_does_not_wait_and_cancels_what_does() {
        let mut orders = Orders::default();
        orders.take(move_to(0.1));
        send(&mut orders, 1);
        orders.take(move_to(0.2));
        let stop = order(Command::Stop);
        orders.take(stop);
        assert_eq!(send(&mut orders, 2), Some(stop));
        orders.take(order(Command::Clear));
        orders.take(stop);
        assert_eq!(orders.waiting().count(), 0);
        assert_eq!(send(&mut orders, 3), None);
        orders.answered(1);
        orders.answered(2);
        orders.take(order(Command::Clear));
        assert!(send(&mut orders, 3).is_some());
    }

    #[test]
    fn what_is_repeated_comes_first_unless_it_is_replaced() {
        let mut orders = Orders::default();
        let (hold, stop) = (order(Command::Hold), order(Command::Stop));
        orders.take(hold);
        orders.repeat(move_to(0.1));
        assert_eq!(orders.next_to_send(), Some(move_to(0.1)));
        orders.take(move_to(0.2));
        orders.repeat(move_to(0.1));
        assert_eq!(orders.next_to_send(), Some(hold));
        assert_eq!(orders.next_to_send(), Some(move_to(0.2)));
        orders.take(stop);
        orders.repeat(move_to(0.1));
        assert_eq!(send(&mut orders, 1), Some(stop));
        orders.repeat(move_to(0.1));
        assert_eq!(orders.next_to_send(), None);
        orders.answered(1);
        orders.repeat(stop);
        assert_eq!(orders.next_to_send(), Some(stop));
    }
}
