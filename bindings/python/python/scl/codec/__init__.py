"""Codecs: encoding messages into bytes and decoding them.

Programs rarely need this module: gates encode and decode by themselves. It is for tools that read recorded frames, and
for tests.
"""

from scl._errors import DecodeError, EncodeError, UnsupportedCodecError
from scl.codec._choose import codec_of
from scl.codec._codec import Codec, Owner
from scl.codec._messages import MessageClasses, lazy_messages, messages_of_descriptors, messages_of_plan

__all__ = [
    "Codec",
    "DecodeError",
    "EncodeError",
    "MessageClasses",
    "Owner",
    "UnsupportedCodecError",
    "codec_of",
    "lazy_messages",
    "messages_of_descriptors",
    "messages_of_plan",
]
