from .functions import frequency_response as frequency_response, range_fault as range_fault
from .response import FrequencyResponse as FrequencyResponse, response as response
