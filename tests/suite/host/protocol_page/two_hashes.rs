//! The product and its test bench have a hash each: a new request of the bench leaves that of the product as it is.

use super::grammar;
use leg_firmware::host_link::{HOST_SCHEMA, HostReply, HostRequest};
use leg_firmware_bench::kernels::Kernel;
use leg_firmware_bench::protocol::{
    BENCH_SCHEMA, BoardReply, BoardStep, EvaluateRequest, KernelRequest, Refusal, Reply, Request,
    TickReply, TickRequest,
};
use postcard_schema::Schema;
use postcard_schema::key::Key;

/// Each hash is made of the messages of its own side alone.
#[test]
fn each_hash_is_that_of_its_own_messages() {
    let product = Key::for_path::<(HostRequest, HostReply)>("leg");
    let bench = Key::for_path::<(Request, Reply)>("leg bench");
    assert_eq!(HOST_SCHEMA, product.to_bytes());
    assert_eq!(BENCH_SCHEMA, bench.to_bytes());
}

#[test]
fn no_message_of_the_product_holds_one_of_the_bench() {
    let (types, _) = grammar::message_types();
    assert!(types.contains(&HostRequest::SCHEMA) && types.len() > 10);
    for bench in [
        Request::SCHEMA,
        Reply::SCHEMA,
        Refusal::SCHEMA,
        EvaluateRequest::SCHEMA,
        KernelRequest::SCHEMA,
        Kernel::SCHEMA,
        TickRequest::SCHEMA,
        TickReply::SCHEMA,
        BoardStep::SCHEMA,
        BoardReply::SCHEMA,
    ] {
        assert!(!types.contains(&bench), "{}", bench.name);
    }
}
