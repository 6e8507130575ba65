//! The radio: sends the application's frames on the configured channel.
//!
//! It starts silent, and falls silent when its configuration is not repeated: it does not detect primary users itself,
//! so it transmits only while a link optimizer watches over it.

use std::time::Duration;

use tokio::time::{Instant, sleep_until};

use crate::Radio;
use crate::band::CHANNELS;
use crate::ospecorr::{Configuration, Configured, Frame, RadioState};

/// How often the state is published when nothing changes.
const STATE_PERIOD: Duration = Duration::from_millis(100);

/// How long a configuration is valid.
pub const VALID_FOR: Duration = Duration::from_millis(500);

/// Runs the radio. Frames that cannot be sent wait: one here, others in the queue of the gate; when that is full, the
/// application waits.
pub async fn run(mut radio: Radio) -> scl::Result<()> {
    let mut state = RadioState::default();
    let mut valid_until = Instant::now();
    let mut held: Option<Frame> = None;
    let mut tick = scl::time::interval(STATE_PERIOD)?;
    loop {
        let before = state;
        tokio::select! {
            // Poll in this order: anything that may silence the radio comes before the next frame.
            biased;
            request = radio.control.recv() => {
                let request = request?;
                let configured = configure(&mut state, request.message());
                if configured.accepted {
                    valid_until = Instant::now() + VALID_FOR;
                }
                // A link optimizer that has been stopped no longer waits for the reply.
                let _gone = request.reply(&configured);
            }
            () = sleep_until(valid_until), if state.transmit => {
                println!("no new configuration for {VALID_FOR:?}");
                state.transmit = false;
            }
            ticked = tick.tick() => {
                ticked?;
                tick.skip_missed();
                radio.state.send(&state).await?;
            }
            // Waits until the air has taken the earlier frames. If another branch completes first, nothing was sent.
            sent = send(&mut radio.bursts, held.as_ref()), if state.transmit && held.is_some() => {
                sent?;
                held = None;
            }
            frame = radio.frames.recv(), if state.transmit && held.is_none() => held = Some(frame?),
        }
        if state != before {
            println!("{}", describe(&state));
            radio.state.send(&state).await?;
        }
    }
}

async fn send(bursts: &mut scl::Push<Frame>, frame: Option<&Frame>) -> Result<(), scl::SendError> {
    match frame {
        Some(frame) => bursts.send(frame).await,
        None => Ok(()),
    }
}

/// Changes the state as requested, or returns the reason why not.
fn configure(state: &mut RadioState, asked: &Configuration) -> Configured {
    if asked.channel >= CHANNELS {
        let reason = format!("channel {} does not exist; the channels are 0 to {}", asked.channel, CHANNELS - 1);
        return Configured { accepted: false, reason };
    }
    *state = RadioState { channel: asked.channel, transmit: asked.transmit };
    Configured { accepted: true, reason: String::new() }
}

fn describe(state: &RadioState) -> String {
    if state.transmit { format!("transmits on channel {}", state.channel) } else { "is silent".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RadioPeer;

    async fn start() -> scl::Result<RadioPeer> {
        let (radio, peer) = Radio::test().await?;
        tokio::spawn(run(radio));
        Ok(peer)
    }

    async fn configure(peer: &mut RadioPeer, channel: u32, transmit: bool) -> scl::Result<Configured> {
        Ok(peer.control.call(&Configuration { channel, transmit }).await?)
    }

    async fn send_frame(peer: &mut RadioPeer, number: u32) -> scl::Result<()> {
        Ok(peer.frames.send(&Frame { number, data: vec![0; 100] }).await?)
    }

    #[tokio::test(start_paused = true)]
    async fn it_is_silent_until_it_is_configured_and_holds_what_it_is_to_send() -> scl::Result<()> {
        let mut peer = start().await?;
        send_frame(&mut peer, 1).await?;
        for _ in 0..20 {
            assert!(!peer.state.recv().await?.transmit);
        }
        assert_eq!(peer.bursts.try_recv()?, None);

        assert!(configure(&mut peer, 3, true).await?.accepted);
        assert_eq!(peer.state.recv().await?, RadioState { channel: 3, transmit: true });
        assert_eq!(peer.bursts.recv().await?.number, 1);
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn a_change_is_published_at_once_and_the_state_ten_times_a_second() -> scl::Result<()> {
        let mut peer = start().await?;
        let begin = Instant::now();
        configure(&mut peer, 3, true).await?;
        assert_eq!(peer.state.recv().await?, RadioState { channel: 3, transmit: true });
        assert_eq!(begin.elapsed(), Duration::ZERO);
        for _ in 0..3 {
            assert!(peer.state.recv().await?.transmit);
        }
        assert_eq!(begin.elapsed(), 3 * STATE_PERIOD);
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn without_configuration_it_falls_silent() -> scl::Result<()> {
        let mut peer = start().await?;
        configure(&mut peer, 3, true).await?;
        tokio::time::sleep(VALID_FOR / 2).await;
        configure(&mut peer, 3, true).await?;
        let begin = Instant::now();
        let mut states = 0;
        while peer.state.recv().await?.transmit {
            states += 1;
            assert!(states < 10, "it still transmits");
        }
        assert_eq!(begin.elapsed(), VALID_FOR);
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn a_channel_that_does_not_exist_is_refused() -> scl::Result<()> {
        let mut peer = start().await?;
        configure(&mut peer, 3, true).await?;
        let configured = configure(&mut peer, CHANNELS, false).await?;
        assert!(!configured.accepted);
        assert_eq!(configured.reason, "channel 8 does not exist; the channels are 0 to 7");
        assert_eq!(peer.state.recv().await?, RadioState { channel: 3, transmit: true });
        assert_eq!(peer.state.recv().await?, RadioState { channel: 3, transmit: true });
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn the_application_waits_while_the_radio_is_silent_and_nothing_is_lost() -> scl::Result<()> {
        let mut peer = start().await?;
        let mut sent = 0;
        let full = tokio::time::timeout(Duration::from_secs(10), async {
            loop {
                send_frame(&mut peer, sent).await.unwrap();
                sent += 1;
            }
        });
        assert!(full.await.is_err());
        configure(&mut peer, 0, true).await?;
        for expected in 0..sent {
            assert_eq!(peer.bursts.recv().await?.number, expected);
            configure(&mut peer, 0, true).await?;
        }
        Ok(())
    }
}
