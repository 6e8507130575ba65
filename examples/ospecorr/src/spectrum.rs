//! The simulated band with its primary users, and the far end of the link.

pub mod air;
pub mod primary_users;
mod random;
pub mod signal;

use std::time::Duration;

use clap::Parser;

use self::air::Air;
use self::primary_users::{PrimaryUsers, Visit};
use crate::Spectrum;
use crate::band::FRAME_TIME;
use crate::ospecorr::{RadioState, Truth};

/// The radio counts as gone, and transmits no longer, after this time without a message from it, in frames: three times
/// the period of its messages.
const RADIO_LOST_AFTER: u32 = 75;

/// How long the band waits for the other components.
const START_WITHIN: Duration = Duration::from_secs(10);

/// Simulates the band and its users.
#[derive(Debug, Parser)]
pub struct Options {
    /// A primary user that transmits in a channel from one time to another, in seconds (several are allowed).
    #[arg(long, value_name = "CHANNEL@FROM..TO", conflicts_with = "random")]
    primary: Vec<Visit>,
    /// Primary users that come and go in all channels at random times.
    #[arg(long)]
    random: bool,
    /// Seed of the random numbers; the same seed gives the same band.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Power of a primary user above the noise in its channel, in dB.
    #[arg(long, value_name = "DB", default_value_t = 10.0, allow_hyphen_values = true, value_parser = snr)]
    snr: f64,
}

fn snr(text: &str) -> Result<f64, String> {
    let snr = text.parse().ok().filter(|it| (-30.0..=60.0).contains(it));
    snr.ok_or_else(|| "not a number from -30 to 60".to_owned())
}

/// Advances in real time, one step for each frame. After a pause of the program it continues from there: time in the
/// band is then late, but never runs faster.
pub async fn run(mut spectrum: Spectrum, options: Options) -> scl::Result<()> {
    let primary_users =
        if options.random { PrimaryUsers::random(options.seed) } else { PrimaryUsers::Scheduled(options.primary) };
    let mut air = Air::new(primary_users, options.snr, options.seed);
    let mut radio = RadioState::default();
    let mut radio_age = 0;
    let mut before = Truth::default();
    // Wait, so time 0 is the same for all components; a missing one only delays the start.
    if let Err(missing) = spectrum.ready(START_WITHIN).await {
        println!("starting without all components: {missing}");
    }
    let mut tick = scl::time::interval(FRAME_TIME)?;
    loop {
        tick.tick().await?;
        tick.skip_missed();
        radio_age += 1;
        if let Some(state) = spectrum.radio.latest()? {
            (radio, radio_age) = (state, 0);
        }
        if air.is_quiet() {
            let (samples, truth) = air.listen(radio.channel);
            spectrum.samples.send(&samples).await?;
            spectrum.truth.send(&truth).await?;
            print_changes(&before, &truth);
            before = truth;
        } else {
            // Frames that the radio sent before it fell silent stay in the queue.
            let transmits = radio.transmit && radio_age < RADIO_LOST_AFTER;
            let frame = if transmits { spectrum.bursts.try_recv()? } else { None };
            if let Some(received) = air.carry(radio.channel, frame) {
                spectrum.received.send(&received).await?;
            }
        }
    }
}

/// Prints which primary users have come and gone since the previous slot.
fn print_changes(before: &Truth, now: &Truth) {
    let seconds = now.time_us as f64 / 1e6;
    for channel in now.primary_channels.iter().filter(|it| !before.primary_channels.contains(it)) {
        println!("{seconds:.3} s: a primary user transmits in channel {channel}");
    }
    for channel in before.primary_channels.iter().filter(|it| !now.primary_channels.contains(it)) {
        println!("{seconds:.3} s: channel {channel} is free; {} frames have collided so far", now.lost);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SpectrumPeer;
    use crate::ospecorr::Frame;
    use tokio::time::Instant;

    /// A band with a primary user in channel 1 for the whole second slot.
    async fn start() -> scl::Result<SpectrumPeer> {
        let (spectrum, peer) = Spectrum::test().await?;
        let options = Options::parse_from(["spectrum", "--primary", "1@0.02..0.04"]);
        tokio::spawn(run(spectrum, options));
        Ok(peer)
    }

    #[tokio::test(start_paused = true)]
    async fn a_block_of_samples_comes_from_each_quiet_period() -> scl::Result<()> {
        let begin = Instant::now();
        let mut peer = start().await?;
        for slot in 1..=50 {
            peer.samples.recv().await?;
            assert_eq!(begin.elapsed(), Duration::from_millis(20) * slot);
        }
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn the_air_takes_a_frame_every_four_milliseconds_outside_of_quiet_periods() -> scl::Result<()> {
        let mut peer = start().await?;
        send_frames(&mut peer, 7).await?;
        peer.radio.send(&RadioState { channel: 1, transmit: true }).await?;
        // The primary user is there in the second slot, with frames 4 to 7.
        for (number, time_us) in [(0, 4_000), (1, 8_000), (2, 12_000), (3, 16_000)] {
            let received = peer.received.recv().await?;
            assert_eq!((received.number, received.time_us, received.length), (number, time_us, 100));
        }
        peer.samples.recv().await?;
        peer.samples.recv().await?;
        send_frames(&mut peer, 1).await?;
        assert_eq!(peer.received.recv().await?.time_us, 44_000);
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn frames_that_wait_are_sent_on_the_channel_of_the_radio_when_it_transmits() -> scl::Result<()> {
        let mut peer = start().await?;
        send_frames(&mut peer, 2).await?;
        peer.radio.send(&RadioState { channel: 5, transmit: false }).await?;
        for _ in 0..10 {
            peer.samples.recv().await?;
        }
        assert_eq!(peer.received.try_recv()?, None);
        peer.radio.send(&RadioState { channel: 6, transmit: true }).await?;
        assert_eq!(peer.received.recv().await?.channel, 6);
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn a_radio_that_is_not_heard_of_does_not_transmit() -> scl::Result<()> {
        let mut peer = start().await?;
        peer.radio.send(&RadioState { channel: 5, transmit: true }).await?;
        send_frames(&mut peer, 1).await?;
        peer.received.recv().await?;
        for _ in 0..RADIO_LOST_AFTER / 5 {
            peer.samples.recv().await?;
        }
        send_frames(&mut peer, 1).await?;
        peer.samples.recv().await?;
        assert_eq!(peer.received.try_recv()?, None);
        Ok(())
    }

    async fn send_frames(peer: &mut SpectrumPeer, count: u32) -> scl::Result<()> {
        for number in 0..count {
            peer.bursts.send(&Frame { number, data: vec![0; 100] }).await?;
        }
        Ok(())
    }

    #[test]
    fn options_are_checked() {
        for (arguments, expected) in [
            (vec!["--primary", "9@1..2"], "the channels are 0 to 7"),
            (vec!["--snr", "loud"], "not a number from -30 to 60"),
            (vec!["--snr", "NaN"], "not a number from -30 to 60"),
            (vec!["--random", "--primary", "1@1..2"], "cannot be used with"),
        ] {
            let error = Options::try_parse_from([["spectrum"].as_slice(), &arguments].concat()).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert_eq!(error.exit_code(), 2);
        }
        Options::try_parse_from(["spectrum", "--snr", "-5"]).unwrap();
    }
}
