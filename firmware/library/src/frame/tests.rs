use super::{Decoder, FrameError, MAX_ENCODED, MAX_FRAME, MAX_PAYLOAD, encode};
use proptest::collection::vec;
use proptest::prelude::{any, proptest};

/// A frame's sequence and payload, or why it was refused.
type Found = Result<(u16, Vec<u8>), FrameError>;

fn feed(decoder: &mut Decoder, bytes: &[u8]) -> Vec<Found> {
    let mut found = Vec::new();
    for &byte in bytes {
        if let Some(frame) = decoder.push(byte) {
            found.push(frame.map(|frame| (frame.sequence, frame.payload.to_vec())));
        }
    }
    found
}

fn decode(bytes: &[u8]) -> Vec<Found> {
    feed(&mut Decoder::new(), bytes)
}

fn framed(sequence: u16, message: &[u8]) -> Vec<u8> {
    let mut out = [0; MAX_FRAME];
    match encode(sequence, &message, &mut out) {
        Ok(frame) => frame.to_vec(),
        Err(error) => panic!("{} bytes: {error}", message.len()),
    }
}

/// What postcard makes of a short slice: its length, then its bytes.
fn payload(message: &[u8]) -> Vec<u8> {
    let mut buffer = [0; MAX_PAYLOAD];
    match postcard::to_slice(message, &mut buffer) {
        Ok(payload) => payload.to_vec(),
        Err(error) => panic!("{} bytes: {error}", message.len()),
    }
}

#[test]
fn the_layout_is_fixed() {
    // Body: 01 02, payload 02 07 00, CRC-32/ISO-HDLC of these five as zlib gives it.
    assert_eq!(
        framed(0x0201, &[7, 0]),
        [5, 1, 2, 2, 7, 5, 0x8f, 0x54, 0x8e, 0x1d, 0]
    );
}

#[test]
fn a_message_must_fill_its_payload() {
    let mut out = [0; MAX_FRAME];
    let Ok(frame) = encode(1, &(1_u8, 2_u8), &mut out) else {
        panic!("two bytes fit")
    };
    let mut decoder = Decoder::new();
    let messages = frame.iter().find_map(|&byte| {
        let frame = decoder.push(byte)?.ok()?;
        Some((
            frame.message::<u8>(),
            frame.message::<(u8, u8)>(),
            frame.message::<[u8; 3]>(),
        ))
    });
    assert_eq!(messages, Some((None, Some((1, 2)), None)));
}

#[test]
fn the_longest_message_fits_and_one_more_byte_does_not() {
    // Two bytes of the payload tell the length.
    let longest = [0x55; MAX_PAYLOAD - 2];
    assert_eq!(decode(&framed(9, &longest)), [Ok((9, payload(&longest)))]);
    let mut out = [0; MAX_FRAME];
    let too_long = [0x55_u8; MAX_PAYLOAD - 1];
    assert_eq!(
        encode(9, &too_long.as_slice(), &mut out),
        Err(FrameError::TooLong)
    );
}

#[test]
fn every_flipped_bit_is_noticed() {
    let message: Vec<u8> = (0..=255).chain(0..=60).collect();
    let frame = framed(513, &message);
    for bit in 0..frame.len() * 8 {
        let mut flipped = frame.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(decode(&flipped).iter().all(Result::is_err), "bit {bit}");
    }
}

#[test]
fn half_a_frame_is_refused_and_the_next_one_read() {
    let frame = framed(3, &[1, 0, 2]);
    for length in 1..frame.len() - 1 {
        let mut bytes = frame[..length].to_vec();
        bytes.push(0);
        bytes.extend(&frame);
        let found = decode(&bytes);
        assert!(found[0].is_err(), "{length} bytes");
        assert_eq!(found[1..], [Ok((3, payload(&[1, 0, 2])))], "{length} bytes");
    }
}

#[test]
fn a_frame_without_its_end_costs_only_the_next_one() {
    let frame = framed(3, &[1, 0, 2]);
    let mut bytes = frame[..frame.len() - 1].to_vec();
    bytes.extend(&frame);
    bytes.extend(&frame);
    let found = decode(&bytes);
    assert_eq!(found.len(), 2);
    assert!(found[0].is_err());
    assert_eq!(found[1], Ok((3, payload(&[1, 0, 2]))));
}

#[test]
fn an_over_long_frame_is_refused_and_the_next_one_read() {
    let mut bytes = vec![1; MAX_ENCODED + 1];
    bytes.push(0);
    bytes.extend(framed(4, &[5]));
    assert_eq!(
        decode(&bytes),
        [Err(FrameError::TooLong), Ok((4, payload(&[5])))]
    );
}

#[test]
fn too_little_for_a_crc_is_too_short() {
    assert_eq!(decode(&[4, 1, 2, 3, 0]), [Err(FrameError::TooShort)]);
    assert_eq!(decode(&[9, 1, 0]), [Err(FrameError::BadCobs)]);
}

#[test]
fn zeros_between_frames_are_no_frames() {
    assert_eq!(decode(&[0, 0, 0]), []);
}

proptest! {
    #[test]
    fn a_message_comes_back(sequence: u16, message in vec(any::<u8>(), 0..MAX_PAYLOAD - 2)) {
        assert_eq!(decode(&framed(sequence, &message)), [Ok((sequence, payload(&message)))]);
    }

    #[test]
    fn a_frame_holds_no_zero_inside(sequence: u16, message in vec(0..3_u8, 0..600)) {
        let frame = framed(sequence, &message);
        assert_eq!(frame.iter().position(|&byte| byte == 0), Some(frame.len() - 1));
    }

    #[test]
    fn garbage_is_never_a_frame_and_costs_nothing_after_a_zero(
        garbage in vec(any::<u8>(), 0..3 * MAX_FRAME),
        message in vec(any::<u8>(), 0..100),
    ) {
        let mut decoder = Decoder::new();
        assert!(feed(&mut decoder, &garbage).iter().all(Result::is_err));
        assert!(feed(&mut decoder, &[0]).iter().all(Result::is_err));
        assert_eq!(feed(&mut decoder, &framed(7, &message)), [Ok((7, payload(&message)))]);
    }
}
