from .functions import frequency_response as frequency_response
from .response import FrequencyResponse as FrequencyResponse, response as response
