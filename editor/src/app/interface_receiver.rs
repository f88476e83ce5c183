//! Messages for the interface: replies of the document, and answers of jobs and dialogs.

use super::interface::Interface;
use dragonfly_runtime::{Address, Context, Receiver};
use std::cell::RefCell;
use std::rc::Rc;

/// Passes messages on to the interface, which is drawn again after each.
struct InterfaceReceiver<M> {
    interface: Rc<RefCell<Interface>>,
    pass: fn(&mut Interface, M),
}

impl<M: Send + 'static> Receiver for InterfaceReceiver<M> {
    type Message = M;

    fn receive(&mut self, message: M, _main: &mut Context) {
        let mut interface = self.interface.borrow_mut();
        (self.pass)(&mut interface, message);
        interface.redraw();
    }
}

/// Returns the address at which `pass` receives messages in the main thread.
pub(super) fn interface_address<M: Send + 'static>(
    main: &mut Context,
    interface: &Rc<RefCell<Interface>>,
    pass: fn(&mut Interface, M),
) -> Address<M> {
    let address = main.handle().reserve_address();
    let interface = Rc::clone(interface);
    main.register_restartable_receiver_at(&address, move |_| InterfaceReceiver {
        interface: Rc::clone(&interface),
        pass,
    });
    address
}
