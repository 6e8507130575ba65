"""Sentences for tests."""


def sentence(text: str) -> bytes:
    """The sentence with its checksum."""
    checksum = 0
    for letter in text.encode():
        checksum ^= letter
    return f"${text}*{checksum:02X}\r\n".encode()


GGA = sentence("GPGGA,123519.20,5041.1960,N,01055.1400,E,1,08,0.9,485.4,M,46.9,M,,")
RMC = sentence("GPRMC,123519.20,A,5041.1960,N,01055.1400,E,010.0,090.0,230394,,")
